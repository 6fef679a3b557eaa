
'use strict';
// A click on a column's head sorts by it, a second one the other way round; cells without a value stay last.
for (const table of document.querySelectorAll('table.sortable')) {
  const heads = [...table.tHead.rows[0].cells];
  const valueOf = cell => cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value);
  const before = (a, b) => {
    const numbers = [a, b].map(x => typeof x === 'number');
    if (numbers[0] && numbers[1]) return a - b;
    if (numbers[0] !== numbers[1]) return numbers[0] ? -Infinity : Infinity;
    return a < b ? -1 : a > b ? 1 : 0;
  };
  heads.forEach((head, column) => head.querySelector('button').addEventListener('click', () => {
    const down = head.getAttribute('aria-sort') === 'ascending';
    for (const other of heads) other.removeAttribute('aria-sort');
    head.setAttribute('aria-sort', down ? 'descending' : 'ascending');
    const rows = [...table.tBodies[0].rows].map((row, place) => ({row, place, value: valueOf(row.cells[column])}));
    rows.sort((a, b) => {
      const order = before(a.value, b.value);
      return (Number.isFinite(order) && down ? -order : order) || a.place - b.place;
    });
    table.tBodies[0].append(...rows.map(entry => entry.row));
  }));
}
// Of two pictures on each other, how much of the lower one is seen.
for (const compare of document.querySelectorAll('.compare')) {
  const slider = compare.querySelector('input');
  const move = () => compare.style.setProperty('--at', slider.value + '%');
  slider.addEventListener('input', move);
  move();
}
