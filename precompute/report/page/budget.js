
'use strict';
// Error by cause, stacked over the sharpness of lobes (colours of Okabe and Ito).
(() => {
  const data = JSON.parse(document.getElementById('data').textContent);
  const colours = ['#0072b2', '#e69f00', '#009e73', '#cc79a7', '#56b4e9', '#777777'];
  const variable = name => getComputedStyle(document.documentElement).getPropertyValue(name).trim();
  const charts = [];

  function draw() {
    for (const chart of charts.splice(0)) chart.destroy();
    const text = variable('--text'), line = variable('--line'), ground = variable('--ground');
    const axis = title => ({stacked: true, title: {display: true, text: title, color: text}, grid: {color: line}, ticks: {color: text}});
    for (const place of data.places) {
      const datasets = place.causes.map((cause, i) => ({label: cause.name, data: cause.error, backgroundColor: colours[i % colours.length], borderColor: ground, borderWidth: 1}));
      charts.push(new Chart(document.getElementById('chart_' + place.id), {
        type: 'bar', data: {labels: data.sharpness, datasets},
        options: {animation: false, responsive: true, maintainAspectRatio: false, scales: {x: axis('sharpness of the lobe'), y: axis('mean |error| of the visible fraction')},
                  plugins: {legend: {position: 'bottom', labels: {color: text}}, tooltip: {callbacks: {label: item => `${item.dataset.label}: ${item.raw.toFixed(4)}`}}}}}));
    }
    if (data.pictures) {
      const bars = (label, key, colour) => ({label, data: data.pictures.map(cause => cause[key]), backgroundColor: colour});
      const plain = title => ({...axis(title), stacked: false});
      charts.push(new Chart(document.getElementById('chart_pictures'), {
        type: 'bar', data: {labels: data.pictures.map(cause => cause.name),
                            datasets: [bars('RMSE by this cause, as displayed', 'error', colours[0]), bars('the same, linear', 'linear', colours[1]), bars('RMSE by which it changes the picture', 'change', colours[5])]},
        options: {indexAxis: 'y', animation: false, responsive: true, maintainAspectRatio: false, scales: {x: plain('RMSE'), y: {grid: {display: false}, ticks: {color: text, autoSkip: false}}},
                  plugins: {legend: {position: 'bottom', labels: {color: text}}, tooltip: {callbacks: {label: item => `${item.dataset.label}: ${item.raw.toFixed(5)}`}}}}}));
    }
    document.documentElement.dataset.drawn = charts.length;
  }

  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', draw);
  draw();
})();
