
'use strict';
// The worst error of each function as a bar, with a mark at its tolerance (colours of Okabe and Ito).
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const variable = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  let chart;

  function draw() {
    if (chart) chart.destroy();
    const text = variable('--text'), line = variable('--line');
    const bars = (label, errors, colour) => ({label, data: errors, backgroundColor: colour});
    const datasets = [bars('float C++', data.float, '#0072b2')];
    if (data.glsl.length > 0) datasets.push(bars('GLSL', data.glsl, '#e69f00'));
    datasets.push({label: 'tolerance', type: 'scatter', data: data.tolerance.map((x, i) => ({x, y: data.functions[i]})), pointStyle: 'line', rotation: 90, radius: 7, borderWidth: 2,
                   borderColor: text, backgroundColor: text});
    chart = new Chart(document.getElementById('chart'), {
      type: 'bar', data: {labels: data.functions, datasets},
      options: {indexAxis: 'y', animation: false, responsive: true, maintainAspectRatio: false,
                scales: {x: {type: 'logarithmic', position: 'top', min: 1e-8, title: {display: true, text: 'worst relative error', color: text}, grid: {color: line},
                             ticks: {color: text, callback: value => /^1e/.test(value.toExponential()) ? value.toExponential() : ''}},
                         y: {grid: {display: false}, ticks: {color: text, autoSkip: false, font: {size: 11}}}},
                plugins: {legend: {labels: {color: text, usePointStyle: true}}, tooltip: {callbacks: {label: item => `${item.dataset.label}: ${(item.raw.x ?? item.raw).toExponential(2)}`}}}}});
    document.documentElement.dataset.drawn = datasets.length;
  }

  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
  draw();
})();
