// Draws `data` of trajectory_page.py on the element #map with Leaflet.
'use strict';
(() => {
  const colors = data.colors;
  const count = data.time_s.length;
  const pointsOf = ([forward, right]) => forward.map((z, i) => [z, right[i]]);
  const estimate = pointsOf(data.estimate);
  const truth = data.truth ? pointsOf(data.truth) : null;

  const element = document.getElementById('map');
  element.style.height = Math.min(620, 0.75 * window.innerHeight) + 'px';
  const map = L.map(element, {
    crs: L.CRS.Simple, preferCanvas: true, attributionControl: false, minZoom: -12, zoomSnap: 0.25,
    zoomDelta: 0.5, wheelPxPerZoomLevel: 120
  });
  const layers = {};
  if (truth) {
    layers.truth = L.polyline(truth, {color: colors.truth, weight: 7, opacity: 0.55, smoothFactor: 0.8});
  }
  layers.estimate = L.polyline(estimate, {color: colors.estimate, weight: 3, smoothFactor: 0.8});
  for (const state of ['degraded', 'lost']) {
    const marks = estimate.filter((_, i) => data.state[i] === state).map(point => L.circleMarker(
      point, {radius: state === 'lost' ? 5 : 4, stroke: false, fillColor: colors[state], fillOpacity: 1}));
    if (marks.length) layers[state] = L.layerGroup(marks);
  }
  for (const layer of Object.values(layers)) layer.addTo(map);
  L.circleMarker(estimate[0], {radius: 7, weight: 2, color: '#fff', fillColor: colors.text, fillOpacity: 1})
    .bindTooltip('start', {permanent: true, direction: 'left', offset: [-6, 0]}).addTo(map);
  L.control.layers(null, Object.fromEntries(Object.entries(layers).map(
    ([name, layer]) => [`<span style="color:${colors[name]}">&#9632;</span> ${name}`, layer])),
    {collapsed: false}).addTo(map);
  L.control.scale({imperial: false, maxWidth: 160}).addTo(map);
  map.fitBounds(L.latLngBounds(truth ? estimate.concat(truth) : estimate), {padding: [30, 30]});

  const meters = (value, digits) => value.toFixed(digits) + ' m';
  function textOf(i) {
    const lines = [`<b>pair ${i} of ${count - 1}</b>`, `time ${data.time_s[i].toFixed(2)} s`,
      `path ${meters(data.path_m[i], 1)}, height ${meters(data.height_m[i], 2)}`];
    if (data.state[i]) lines.push('state ' + data.state[i]);
    if (truth) {
      const share = data.path_m[i] > 0 ? ` (${(100 * data.error_m[i] / data.path_m[i]).toFixed(2)} %)` : '';
      lines.push(`position error ${meters(data.error_m[i], 2)}${share}`,
        `error of the step ${(1000 * data.step_error_m[i]).toFixed(1)} mm`);
    }
    return lines.join('<br>');
  }

  // The pose next to the pointer, with its true place.
  const place = L.circleMarker(estimate[0], {radius: 6, weight: 2, color: colors.text, fill: false});
  const link = L.polyline([], {color: colors.text, weight: 1.5});
  const note = L.tooltip({direction: 'auto', offset: [12, 0]});
  function nearest(pointer) {
    let best = -1, bestDistance = 40;  // pixels
    for (let i = 0; i < count; ++i) {
      const distance = map.latLngToContainerPoint(estimate[i]).distanceTo(pointer);
      if (distance < bestDistance) [best, bestDistance] = [i, distance];
    }
    return best;
  }
  function show(event) {
    const i = nearest(event.containerPoint);
    for (const layer of [place, link, note]) layer.remove();
    if (i < 0) return;
    place.setLatLng(estimate[i]).addTo(map);
    if (truth) link.setLatLngs([estimate[i], truth[i]]).addTo(map);
    note.setLatLng(estimate[i]).setContent(textOf(i)).addTo(map);
  }
  map.on('mousemove click', show);
})();
