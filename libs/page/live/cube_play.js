// Frames: images that a number alone tells apart, one after the other under one stretch.

// The images of the sequence that an image belongs to, in their order.
function framesOf(number) {
  const part = name => /^(.*)_(\d{4,})$/.exec(name), own = part(about.images[number].name), one = about.images[number];
  if (!own) return [number];
  const alike = about.images.map((image, i) => ({image, i, part: part(image.name)})).filter(({image, part}) =>
    part && part[1] === own[1] && image.columns === one.columns && image.rows === one.rows && image.bands.length === one.bands.length);
  return alike.sort((a, b) => Number(a.part[2]) - Number(b.part[2])).map(({i}) => i);
}

const player = {timer: null, ranges: new Map()};

function buildPlayer() {
  ui.frame = make('input', {type: 'range', id: 'frame', min: 0, step: 1, oninput: () => choose(framesOf(state.image)[Number(ui.frame.value)], true)});
  ui.play = make('button', {id: 'play', onclick: () => player.timer ? stop() : play()}, 'play');
  ui.rate = make('input', {type: 'number', id: 'rate', value: '5', min: 0.2, max: 60, step: 1, onchange: () => { if (player.timer) play(); }});
  ui.record = make('button', {id: 'record', onclick: record, hidden: !window.MediaRecorder}, 'save as film');
  ui.same = make('input', {type: 'checkbox', id: 'same', checked: true, onchange: () => draw()});
  ui.player = make('div', {id: 'player', hidden: true}, ui.frame, make('div', {className: 'row'}, ui.play, ui.rate, 'a second', ui.record),
    make('label', {}, ui.same, ' one stretch for all frames'));
  return ui.player;
}

function showPlayer() {
  const frames = framesOf(state.image);
  ui.player.hidden = frames.length < 2;
  ui.frame.max = frames.length - 1;
  ui.frame.value = frames.indexOf(state.image);
}

function stop() {
  clearInterval(player.timer);
  player.timer = null;
  ui.play.textContent = 'play';
}

function advance() {
  const frames = framesOf(state.image), next = frames[(frames.indexOf(state.image) + 1) % frames.length];
  choose(next, true);
  ui.frame.value = frames.indexOf(next);
}

function play() {
  stop();
  player.timer = setInterval(advance, 1000 / Math.min(60, Math.max(0.2, Number(ui.rate.value) || 5)));
  ui.play.textContent = 'stop';
}

// One turn of all frames as WebM, by what the browser has.
function record() {
  stop();
  const stream = ui.canvas.captureStream(), recorder = new MediaRecorder(stream), parts = [];
  recorder.ondataavailable = e => parts.push(e.data);
  recorder.onstop = () => save(`${image().name.replace(/_\d+$/, '')}.webm`, new Blob(parts, {type: recorder.mimeType}));
  recorder.start();
  let left = framesOf(state.image).length;
  player.timer = setInterval(() => {
    if (left-- > 0) return advance();
    stop();
    recorder.stop();
  }, 1000 / Math.min(60, Math.max(0.2, Number(ui.rate.value) || 5)));
}

// The ranges of all frames together, one a band that is shown; null where each picture has its own.
function rangesShown() {
  const frames = framesOf(state.image);
  if (frames.length < 2 || !ui.same.checked) return null;
  const rgb = state.mode === 'rgb', bands = rgb ? state.rgb : [state.band];
  const key = JSON.stringify([frames[0], bands, rgb, state.low, state.high, state.each, toKelvin()]);
  if (player.ranges.has(key)) return player.ranges.get(key);
  const lists = bands.map(() => []);
  for (const f of frames) {
    const all = bands.map(b => numbersKept(`i${f}.v${b}`));
    if (all.some(list => !list)) return null;
    all.forEach((list, k) => {
      const stride = Math.max(1, Math.floor(list.length * frames.length / 60000));
      for (let i = 0; i < list.length; i += stride) lists[k].push(toKelvin() ? kelvinOf(image(), bands[k], list[i]) : list[i]);
    });
  }
  const ranges = rgb && !state.each ? Array(3).fill(commonRange(lists)) : lists.map(list => percentiles([list], state.low, state.high));
  player.ranges.set(key, ranges);
  return ranges;
}
