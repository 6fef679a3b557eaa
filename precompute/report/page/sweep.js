
'use strict';
// The points of a sweep: one shape and colour (Okabe and Ito) for each form, faint where another point costs no more and errs no more.
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const chosen = Object.fromEntries(['cost', 'measure', 'place'].map(id => [id, document.getElementById(id)]));
  const looks = [['circle', '#0072b2'], ['triangle', '#d55e00'], ['rect', '#009e73'], ['rectRot', '#cc79a7'], ['cross', '#e69f00'], ['star', '#56b4e9']];
  const dark = matchMedia('(prefers-color-scheme: dark)');
  const variable = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const round = value => Number(value.toPrecision(2)).toString();
  let chart;

  function draw() {
    const cost = chosen.cost.value, measure = Number(chosen.measure.value), place = chosen.place.value;
    const errors = data.points.map(point => point.error[place][measure]);
    const front = data.fronts[place][measure][cost];
    const forms = [...new Set(data.points.map(point => point.form))];
    const faint = variable('--faint'), line = variable('--line'), text = variable('--text');
    const datasets = forms.map((form, f) => {
      const [pointStyle, colour] = looks[f % looks.length];
      const own = data.points.map((point, i) => ({x: point[cost], y: errors[i], label: point.label, front: front[i], form: point.form}))
        .filter(point => point.form === form && point.x > 0 && point.y > 0);
      const colours = own.map(point => point.front ? colour : faint);
      return {label: form, data: own, pointStyle, radius: own.map(point => point.front ? 7 : 5), hoverRadius: 9, borderWidth: 2,
              borderColor: colours, backgroundColor: colours};
    });
    const shown = [...forms.map((form, f) => looks[f % looks.length]), ['line', text]];
    const shownPoints = datasets.flatMap(set => set.data);
    // The legend shows the first point's colour, which may be a faint one: say the form's own.
    const legend = {usePointStyle: true, color: text, generateLabels: at => at.data.datasets.map((set, i) => ({
      text: set.label, datasetIndex: i, pointStyle: set.pointStyle, strokeStyle: shown[i][1], fillStyle: shown[i][1],
      fontColor: text, lineWidth: 2, hidden: !at.isDatasetVisible(i)}))};
    const onFront = data.points.map((point, i) => ({x: point[cost], y: errors[i], on: front[i]})).filter(point => point.on && point.x > 0 && point.y > 0);
    onFront.sort((a, b) => a.x - b.x || b.y - a.y);
    datasets.push({label: 'front', data: onFront, type: 'line', stepped: true, pointRadius: 0, pointHitRadius: 0, borderColor: text, borderWidth: 1, pointStyle: 'line'});
    const axis = (title, values) => ({type: 'logarithmic', min: Math.min(...values) / 1.2, max: Math.max(...values) * 1.2, title: {display: true, text: title, color: text}, grid: {color: line},
                            ticks: {color: text, callback: value => /^[125]/.test(value.toExponential()) ? round(value) : ''}});
    const titles = {bytes_per_vertex: 'bytes a vertex', cpu_seconds: 'CPU seconds of a bake', frame_ms: 'milliseconds a frame'};
    if (chart) chart.destroy();
    chart = new Chart(document.getElementById('chart'), {
      type: 'scatter', data: {datasets},
      options: {animation: false, responsive: true, maintainAspectRatio: false,
                scales: {x: axis(titles[cost], shownPoints.map(point => point.x)), y: axis(chosen.measure.value === String(data.points[0].error.vertices.length - 1) ? 'RMSE of the picture' : 'mean |error| of the visible fraction', shownPoints.map(point => point.y))},
                plugins: {legend: {position: 'bottom', labels: legend},
                          tooltip: {filter: item => item.dataset.label !== 'front',
                                    callbacks: {label: item => `${item.raw.label}: ${round(item.raw.x)}, error ${item.raw.y.toFixed(4)}`}}}}});
    document.documentElement.dataset.drawn = datasets.reduce((sum, set) => sum + set.data.length, 0);
  }

  for (const select of Object.values(chosen)) select.addEventListener('change', draw);
  dark.addEventListener('change', draw);
  draw();
})();
