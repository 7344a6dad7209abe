// A plot over the frames, in `host`. series: [{name, values}], a value a frame, null where it is not known; onPick(index) is
// called when a frame is pointed at. Gives null where nothing is known, else {title, draw(index)}.
function makePlot(host, { title, unit, series, worse, onPick }) {
  const figure = document.createElement('figure'), caption = document.createElement('figcaption'), name = document.createElement('b');
  const value = document.createElement('span'), canvas = document.createElement('canvas');
  name.textContent = title;
  caption.append(name, value);
  figure.append(caption, canvas);
  host.append(figure);
  const known = series.flatMap((s) => s.values).filter((v) => v !== null && isFinite(v));
  if (known.length === 0) {
    value.textContent = 'not recorded';
    canvas.remove();
    return null;
  }
  const count = series[0].values.length, top = Math.max(...known, 1e-9) * 1.08;
  const index = (event) => Math.round((event.offsetX / canvas.clientWidth) * (count - 1));
  canvas.addEventListener('pointerdown', (event) => { canvas.setPointerCapture(event.pointerId); onPick(index(event)); });
  canvas.addEventListener('pointermove', (event) => { if (event.buttons & 1) onPick(index(event)); });
  const style = getComputedStyle(document.documentElement);
  function draw(frame) {
    const scale = window.devicePixelRatio || 1, width = canvas.clientWidth || 300, height = 74;
    canvas.width = width * scale;
    canvas.height = height * scale;
    const pen = canvas.getContext('2d');
    pen.scale(scale, scale);
    const x = (i) => (count > 1 ? i / (count - 1) : 0.5) * (width - 1) + 0.5, y = (v) => height - 1 - (v / top) * (height - 4);
    pen.strokeStyle = style.getPropertyValue('--line');
    pen.strokeRect(0.5, 0.5, width - 1, height - 1);
    series.forEach((s, k) => {
      pen.strokeStyle = style.getPropertyValue(worse ? '--bad' : '--accent');
      pen.globalAlpha = k === 0 ? 1 : 0.4;
      pen.lineWidth = 1.4;
      pen.beginPath();
      let down = false;
      s.values.forEach((v, i) => {
        if (v === null || !isFinite(v)) { down = false; return; }
        down ? pen.lineTo(x(i), y(v)) : pen.moveTo(x(i), y(v));
        down = true;
      });
      pen.stroke();
    });
    pen.globalAlpha = 1;
    pen.strokeStyle = style.getPropertyValue('--ink');
    pen.lineWidth = 1;
    pen.beginPath();
    pen.moveTo(x(frame), 1);
    pen.lineTo(x(frame), height - 1);
    pen.stroke();
    value.textContent = series.map((s) => {
      const v = s.values[frame];
      return s.name + ' ' + (v === null || v === undefined || !isFinite(v) ? '-' : v >= 100 ? v.toFixed(0) : +v.toPrecision(3)) + unit;
    }).join('   ');
  }
  return { title, draw };
}
