'use strict';
const $ = id => document.getElementById(id);
const data = JSON.parse($('data').textContent);
const unpacked = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));
const element = (name, properties = {}, ...children) => {
    const made = Object.assign(document.createElement(name), properties);
    made.append(...children);
    return made;
};
const drawn = (name, attributes = {}, ...children) => { // an element of a picture
    const made = document.createElementNS('http://www.w3.org/2000/svg', name);
    for (const [key, value] of Object.entries(attributes))
        made.setAttribute(key, value);
    made.append(...children);
    return made;
};
const spaced = n => Math.round(n).toString().replace(/\B(?=(\d{3})+$)/g, '\u202f');
const short = n => {
    const e = Math.min(Math.floor(Math.log10(Math.max(n, 1)) / 3), 4);
    return (n / 1000 ** e).toPrecision(3).replace(/e\+.*/, '') + ['', ' k', ' M', ' G', ' T'][e];
};
const duration = s => s < 0.1 ? `${(1000 * s).toPrecision(2)} ms` : s < 99 ? `${s.toPrecision(2)} s` : s < 5900
    ? `${(s / 60).toPrecision(2)} min` : `${(s / 3600).toPrecision(2)} h`;

// What is shown: the scene's name, or its text where that is not the one of this name, and how each side is drawn.
const first_scene = 'showcase';
const drawing = {number: 'q32', samples: 1, levels: 0, threshold: 1 / 16, depth: 5, cutoff: 0.0014};
const truth = {number: 'double', samples: 64, levels: 0, threshold: 1 / 16, depth: 8, cutoff: 0};
const shown = {scene: first_scene, text: data.scenes[first_scene], size: '320x240', board: 'microbit',
               clock: null, // MHz, where it is not the board's
               sides: [{...drawing, number: 'q16'}, {...drawing}]};
const clock = () => shown.clock ?? data.parts[shown.board].mhz;
const is_changed = () => shown.text !== data.scenes[shown.scene];
const scene_file = () => is_changed() ? 'scene.nff' : `scenes/${shown.scene}.nff`;

// A slider's places, what they stand for, and when there is one: `s` is a side's settings, `scene` what was read.
// `able` is what a link may say, and `expected` its name.
const squares = [1, 4, 9, 16, 25, 36, 49, 64];
const cutoffs = [0, 0.0005, 0.0014, 0.004, 0.01, 0.03, 0.1, 0.3, 1];
const whole = (v, from, to) => Number.isInteger(v) && v >= from && v <= to;
const share = {able: v => v >= 0 && v <= 1, expected: 'a number from 0 to 1'};
const dials = {
    samples: {label: 'Samples a pixel', help: 'Rays of the eye in each pixel, whose colours are averaged',
              values: squares, when: s => s.levels === 0,
              able: v => whole(Math.sqrt(v), 1, 64), expected: 'a square from 1 to 4096'},
    levels: {label: 'Adaptive levels', help: 'How often a part of a pixel whose samples differ is cut into quarters',
             values: [0, 1, 2, 3, 4, 5, 6], text: v => v === 0 ? 'off' : String(v),
             able: v => whole(v, 0, 6), expected: 'a whole number from 0 to 6'},
    threshold: {label: 'Its threshold', help: 'The least difference of samples, 1 from black to white, that is cut',
                values: Array.from({length: 33}, (_, i) => i / 64), text: v => v.toFixed(3), when: s => s.levels > 1,
                ...share},
    depth: {label: 'Depth of rays', help: 'How many rays follow one another by mirrors and glass, with the first one',
            values: Array.from({length: 16}, (_, i) => i + 1), when: (s, scene) => scene.spawns,
            able: v => whole(v, 1, 64), expected: 'a whole number from 1 to 64'},
    cutoff: {label: 'Least weight', help: 'Mirrored and refracted rays that count for less are not traced',
             values: cutoffs, when: (s, scene) => scene.spawns, ...share},
};

// A worker and its latest job. One that cannot listen, as it computes light between surfaces, is put away.
let module = null, told = null, worker_url = null, ids = 0;
const files = Object.fromEntries(Object.entries(data.files).map(([name, text]) => [name, unpacked(text)]));
class Tracer {
    start(job, answer) {
        if (this.solving)
            this.end();
        if (this.worker === undefined) {
            this.worker = new Worker(worker_url);
            this.worker.postMessage({module, files});
            this.worker.onmessage = ({data: message}) => {
                if (message.id !== this.id)
                    return;
                this.solving = message.solving ?? this.solving;
                this.answer(message);
            };
        }
        this.id = ++ids;
        this.answer = answer;
        this.worker.postMessage({...job, id: this.id, name: scene_file().replace('scenes/', ''), text: shown.text});
    }
    end() {
        this.worker?.terminate();
        this.worker = undefined;
        this.solving = false;
    }
    // Takes no more answers; the job ends when the next one comes.
    stop() {
        this.id = 0;
        if (this.solving)
            this.end();
    }
}
const judge = new Tracer(), surveyor = new Tracer();

function state(name) {
    document.body.dataset.state = name;
}

const picture_size = () => shown.size === 'scene' ? [0, 0] : shown.size.split('x').map(Number);

// One of the two pictures.
class Side {
    constructor(index) {
        this.index = index;
        this.tracer = new Tracer();
        this.name = 'AB'[index];
        this.canvas = element('canvas', {tabIndex: 0});
        this.canvas.setAttribute('role', 'img');
        this.title = element('span');
        this.progress = element('progress', {max: 1, value: 0});
        this.progress.setAttribute('aria-label', `Drawing picture ${this.name}`);
        this.facts = element('p', {className: 'facts'});
        this.root = element('figure', {className: 'picture'},
                            element('h2', {textContent: `Picture ${this.name}`}, this.title), this.canvas,
                            this.progress, this.facts, this.controls());
        choose_pixels(this.canvas);
    }
    get settings() { return shown.sides[this.index]; }

    controls() {
        const numbers = element('div', {className: 'numbers', role: 'radiogroup'});
        numbers.setAttribute('aria-label', 'Number system');
        this.radios = told.numbers.map(number => element('input', {
            type: 'radio', name: `number-${this.name}`, value: number,
            onchange: () => this.change({number}),
        }));
        numbers.append(...this.radios.map(radio =>
            element('label', {}, radio, element('span', {textContent: radio.value}))));
        this.dials = Object.entries(dials).map(([key, dial]) => {
            const id = `${key}-${this.name}`, output = element('output');
            const range = element('input', {type: 'range', min: 0, max: dial.values.length - 1, id});
            range.oninput = () => this.change({[key]: dial.values[range.value]});
            return {key, dial, range, output, root: element('label', {className: 'dial', title: dial.help},
                                                            element('span', {textContent: dial.label}), range, output)};
        });
        return element('fieldset', {}, element('legend', {textContent: `How picture ${this.name} is drawn`}), numbers,
                       ...this.dials.map(d => d.root));
    }
    change(part) {
        link_mistakes = [];
        Object.assign(this.settings, part);
        show_chosen(null);
        this.draw();
    }
    show_dials(scene) {
        const s = this.settings;
        for (const radio of this.radios)
            radio.checked = radio.value === s.number;
        for (const {key, dial, range, output, root} of this.dials) {
            const far = dial.values.map(v => Math.abs(v - s[key]));
            range.value = far.indexOf(Math.min(...far)); // the nearest
            output.textContent = (dial.text ?? String)(s[key]);
            range.setAttribute('aria-valuetext', output.textContent);
            if (scene !== undefined || dial.when?.length !== 2)
                root.hidden = dial.when !== undefined && !dial.when(s, scene);
        }
    }

    draw() {
        const [width, height] = picture_size();
        this.done = false;
        this.rgb = null;
        state('drawing');
        judge.stop();
        this.show_dials(this.scene);
        this.root.classList.add('stale');
        this.progress.value = 0;
        this.title.textContent = describe_settings(this.settings);
        save_link();
        this.tracer.start({kind: 'draw', width, height, settings: this.settings}, m => this.take(m));
    }
    take(m) {
        if (m.failed !== undefined) {
            this.facts.textContent = m.failed;
            this.facts.className = 'facts wrong';
            this.failed = true;
            this.done = true;
            compare();
            return;
        }
        if (m.solving)
            this.facts.textContent = 'computing the light between surfaces …';
        if (m.scene !== undefined) {
            this.failed = false;
            this.scene = m.scene;
            this.built = m.built;
            this.facts.className = 'facts';
            this.canvas.width = m.built.width;
            this.canvas.height = m.built.height;
            this.rgb = new Uint8Array(3 * m.built.width * m.built.height);
            this.show_dials(m.scene);
            scene_read(this);
            if (this.index === 0)
                show_run();
        }
        if (m.rgb !== undefined) {
            this.rgb.set(m.rgb, m.first * this.built.width * 3);
            paint(this.canvas, m.rgb, m.first);
            this.root.classList.remove('stale');
            this.progress.value = m.part;
            this.facts.textContent = `${Math.round(100 * m.part)} %, ${(m.ms / 1000).toFixed(2)} s`;
        }
        if (m.done) {
            const rays = m.rays.reduce((a, b) => a + b), kinds = ['camera', 'shadow', 'mirrored', 'refracted'];
            this.ms = m.ms;
            this.rays = rays;
            this.done = true;
            this.canvas.setAttribute('aria-label', `Picture ${this.name}: ${shown.scene}, `
                                     + `${describe_settings(this.settings)}. Arrow keys choose a pixel.`);
            this.facts.textContent = `${(m.ms / 1000).toFixed(2)} s in this browser · ${spaced(rays)} rays`;
            this.facts.title = m.rays.map((n, i) => `${kinds[i]}: ${spaced(n)}`).join(', ');
            this.progress.value = 0;
            compare();
        }
    }
}

function describe_settings(s) {
    return s.number + (s.levels !== 0 ? `, adaptive ${s.levels}` : s.samples !== 1 ? `, ${s.samples} samples` : '');
}

function paint(canvas, rgb, first_row) {
    const image = new ImageData(canvas.width, rgb.length / 3 / canvas.width);
    for (let i = 0, j = 0; i < rgb.length; j += 4) {
        image.data[j] = rgb[i++];
        image.data[j + 1] = rgb[i++];
        image.data[j + 2] = rgb[i++];
        image.data[j + 3] = 255;
    }
    canvas.getContext('2d').putImageData(image, 0, first_row);
}

// The message beside the text.
function show_message(text, wrong) {
    const message = $('message'), place = /^[^\s:]*:(\d+):(?:(\d+):)?/.exec(text);
    message.className = wrong ? 'wrong' : '';
    message.replaceChildren();
    $('text').setAttribute('aria-invalid', wrong);
    if (place === null || !wrong)
        return message.append(text);
    const onclick = () => go_to(+place[1], +(place[2] ?? 1));
    message.append(element('button', {type: 'button', textContent: place[0].slice(0, -1), title: 'Go there', onclick}),
                   text.slice(place[0].length - 1));
}
function go_to(line, column) {
    const lines = shown.text.split('\n'), area = $('text');
    const at = lines.slice(0, line - 1).join('\n').length + (line > 1 ? 1 : 0) + column - 1;
    area.focus();
    const length = column === 1 ? lines[line - 1].length : 1; // the line, or the byte
    area.setSelectionRange(at, Math.min(at + length, shown.text.length));
    area.scrollTop = (line - 6) * parseFloat(getComputedStyle(area).lineHeight);
}
function scene_read(side) {
    const warnings = [...side.scene.warnings, ...sides.flatMap(s => s.built?.warnings ?? [])];
    const lines = warnings.map(w => `Warning, line ${w.line}: ${w.text}${w.count > 1 ? ` (${w.count} in all)` : ''}`);
    show_message([...new Set([...link_mistakes, ...lines])].join('\n') || side.scene.title, false);
    const panel = /^[ \t]*panel[ \t]+(\d+)/m.exec(shown.text);
    $('places-dial').hidden = side.scene.panels === 0 || panel === null;
    if (panel !== null) {
        $('places').value = panel[1];
        $('places-dial').querySelector('output').textContent = panel[1];
    }
}

// The difference of the two.
const scale = [[24, 26, 30], [38, 58, 110], [46, 108, 164], [62, 160, 140], [150, 190, 70], [236, 190, 56],
               [236, 120, 44], [212, 50, 60], [255, 230, 240]]; // 0, 1, 3, 7, ... 255
function false_colour(level) {
    const at = Math.log2(1 + level), i = Math.min(Math.floor(at), 7), part = at - i;
    return scale[i].map((c, k) => Math.round(c + (scale[i + 1][k] - c) * part));
}
const colours = Array.from({length: 256}, (_, level) => false_colour(level));
function show_scale() {
    const at = i => 2 ** (i / 255 * 8) - 1;
    paint($('scale'), new Uint8Array(Array.from({length: 256}, (_, i) => false_colour(at(i))).flat()), 0);
    document.querySelector('.ticks').replaceChildren(...[1, 3, 7, 15, 31, 63, 127].map(level => element('b', {
        textContent: level, style: `left: ${Math.log2(1 + level) / 8 * 100}%`})));
}
let compared = null, chosen_pixel = null; // of the three pictures; at first the worst
function compare() {
    const [a, b] = sides;
    if (!a.done || !b.done)
        return;
    if (a.failed || b.failed) {
        const why = a.facts.textContent;
        if (a.failed && b.failed && why === b.facts.textContent) { // the text's fault, not a number system's
            show_message(why, true);
            sides.forEach(side => side.facts.textContent = 'Not drawn');
        }
        state('error');
        return;
    }
    const {width, height} = a.built;
    judge.start({kind: 'compare', width, height, a: a.rgb, b: b.rgb}, m => {
        if (m.failed !== undefined)
            return;
        const f = m.figures, mean = f.squares / (3 * width * height);
        compared = {...f, psnr: mean === 0 ? Infinity : 10 * Math.log10(255 ** 2 / mean), map: m.map};
        const canvas = $('map');
        canvas.width = width;
        canvas.height = height;
        paint(canvas, new Uint8Array(Array.from(m.map, level => colours[level]).flat()), 0);
        const rows = [['PSNR', mean === 0 ? 'equal' : `${compared.psnr.toFixed(1)} dB`]];
        if (f.flip !== undefined)
            rows.push(['FLIP, mean', f.flip.toFixed(4)],
                      ['Seen to differ', `${(100 * f.seen).toFixed(2)} % of pixels`]);
        rows.push(['Pixels that differ', `${spaced(f.differ)} of ${spaced(width * height)}`],
                  ['Largest difference', `${f.most} of 255 levels`],
                  ['Time here, A : B', `${(a.ms / 1000).toFixed(2)} s : ${(b.ms / 1000).toFixed(2)} s`],
                  ['Rays, A : B', `${spaced(a.rays)} : ${spaced(b.rays)}`]);
        $('figures').replaceChildren(...rows.flatMap(([name, value]) => [element('dt', {textContent: name}),
                                                                        element('dd', {textContent: value})]));
        if (chosen_pixel === null)
            chosen_pixel = worst_pixel();
        state('done');
        survey();
        show_pixel();
    });
}

// A pixel, by the mouse or by arrow keys, on any of the three pictures.
function choose_pixels(canvas) {
    canvas.onclick = e => choose(Math.floor(e.offsetX / canvas.clientWidth * canvas.width),
                                 Math.floor(e.offsetY / canvas.clientHeight * canvas.height));
    canvas.onkeydown = e => {
        const step = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]}[e.key];
        if (step === undefined)
            return;
        e.preventDefault();
        const [x, y] = chosen_pixel ?? [canvas.width >> 1, canvas.height >> 1], far = e.shiftKey ? 10 : 1;
        choose(x + step[0] * far, y + step[1] * far);
    };
}
function worst_pixel() {
    const at = compared.map.indexOf(compared.most), {width} = $('map');
    return [at % width, Math.floor(at / width)];
}
// What is around a pixel, large.
const lens_reach = 7;
function lens(label, colour_at) {
    const edge = 2 * lens_reach + 1, {width, height} = $('map'), rgb = [];
    const canvas = element('canvas', {width: edge, height: edge});
    for (let y = chosen_pixel[1] - lens_reach; y <= chosen_pixel[1] + lens_reach; y++)
        for (let x = chosen_pixel[0] - lens_reach; x <= chosen_pixel[0] + lens_reach; x++)
            rgb.push(...(x < 0 || y < 0 || x >= width || y >= height ? [128, 128, 128] : colour_at(y * width + x)));
    paint(canvas, new Uint8Array(rgb), 0);
    return element('figure', {}, canvas, element('figcaption', {textContent: label}));
}
function choose(x, y) {
    const {width, height} = $('map');
    chosen_pixel = [Math.max(0, Math.min(x, width - 1)), Math.max(0, Math.min(y, height - 1))];
    show_pixel();
}
function show_pixel() {
    if (chosen_pixel === null || compared === null || sides.some(s => !s.done || s.failed))
        return;
    const {width, height} = sides[0].built;
    chosen_pixel = [Math.min(chosen_pixel[0], width - 1), Math.min(chosen_pixel[1], height - 1)];
    const [x, y] = chosen_pixel, at = y * width + x, apart = compared.map[at];
    const of = (side, i) => [...side.rgb.subarray(3 * i, 3 * i + 3)];
    $('pixel').replaceChildren(
        element('b', {textContent: `Pixel ${x}, ${y}: `
            + (apart === 0 ? 'equal' : `${apart} level${apart === 1 ? '' : 's'} apart`)}),
        ...sides.map(side => lens(`${side.name}: ${of(side, at).join(' ')}`, i => of(side, i))),
        lens('difference', i => colours[compared.map[i]]));
    clearTimeout(asking);
    if ($('why').open)
        asking = setTimeout(explain, 100);
}
// The rays of the pixel, of picture A and of B beside it. What would be too long to look through is cut off.
const longest_explanation = 150000;
let asking = 0;
function explain() {
    if (sides.some(s => !s.done || s.failed))
        return;
    const [a, b] = shown.sides, [x, y] = chosen_pixel, [width, height] = picture_size();
    const of = JSON.stringify(shown.sides);
    judge.start({kind: 'explain', width, height, x, y, settings: same(a, b) ? [a] : [a, b]}, m => {
        if (m.solving !== undefined)
            return;
        let text = m.text ?? m.failed;
        if (text.length > longest_explanation)
            text = text.slice(0, text.lastIndexOf('\n', longest_explanation))
                + '\n… and much more: fewer samples have less to explain, and `qray explain` prints it all';
        // Lines of the text lead there. What parts the two stands out.
        const linked = line => line.split(/(line \d+)/).map((part, i) => i % 2 === 0 ? part
            : element('button', {type: 'button', textContent: part, onclick: () => go_to(+part.slice(5), 1)}));
        $('explain').replaceChildren(...text.split(/(?<=\n)/).flatMap(line => /^[| +-]*! /.test(line)
            ? element('mark', {}, ...linked(line)) : linked(line)));
        Object.assign($('explain').dataset, {pixel: `${x},${y}`, settings: of});
    });
}

// The frontier: settings that are worth choosing on a board.
const surveyed_pixels = 4800;
const samplings = [{samples: 1, levels: 0}, {samples: 4, levels: 0}, {samples: 16, levels: 0}, {samples: 1, levels: 2},
                   {samples: 1, levels: 3}];
let found = [], survey_key = null, chosen_point = null;
function survey() {
    const [width, height] = picture_size();
    const key = JSON.stringify([shown.text, shown.size]);
    if (key === survey_key)
        return;
    survey_key = key;
    found = [];
    const settings = [truth, ...told.numbers.flatMap(number => samplings.map(s => ({...drawing, number, ...s})))];
    surveyor.start({kind: 'frontier', width, height, pixels: surveyed_pixels, settings}, m => {
        if (m.part !== undefined)
            $('measuring').value = m.part;
        if (m.error !== undefined) {
            const {settings, rays, exact, error} = m;
            found.push({settings, rays, exact, db: error === 0 ? 99 : 10 * Math.log10(255 ** 2 / error)});
            show_frontier();
        }
        if (m.done || m.failed !== undefined) {
            $('measuring').value = 0;
            document.body.dataset.frontier = m.failed ?? 'done';
            count_rays();
        }
    });
    delete document.body.dataset.frontier;
    delete document.body.dataset.counted;
    show_frontier();
}
// Then the whole picture is drawn with each setting that is worth choosing, and all its rays are counted.
function count_rays() {
    if (document.body.dataset.frontier !== 'done')
        return;
    const next = points_of(shown.board).find(p => p.best && !p.exact)?.settings, [width, height] = picture_size();
    if (next === undefined) {
        surveyor.stop();
        $('measuring').value = 0;
        document.body.dataset.counted = shown.board;
        return;
    }
    delete document.body.dataset.counted;
    surveyor.start({kind: 'count', width, height, settings: next}, m => {
        $('measuring').value = m.part ?? 0;
        if (m.rays !== undefined) {
            Object.assign(found.find(p => p.settings === next), {rays: m.rays, exact: true});
            show_frontier();
            count_rays();
        }
    });
}
// Instructions a ray: those of this very scene where the study has them, else the mean of its scenes, and how far they
// are from it.
function cost(board, number) {
    if (data.costs[board][number] === undefined)
        return null;
    const {rays: known, cycles} = data.costs[board][number];
    if (!is_changed() && known[shown.scene] !== undefined)
        return {mean: known[shown.scene], own: true, cycles};
    const all = Object.values(known);
    return {mean: Math.exp(all.reduce((sum, n) => sum + Math.log(n), 0) / all.length), own: false, cycles,
            low: Math.min(...all), high: Math.max(...all)};
}
function points_of(board) {
    const points = found.flatMap(p => {
        const c = cost(board, p.settings.number);
        if (c === null)
            return [];
        const instructions = p.rays * c.mean;
        return [{...p, instructions, seconds: instructions * c.cycles / (1e6 * clock())}];
    }).sort((p, q) => p.instructions - q.instructions);
    let best = -Infinity;
    for (const p of points) {
        p.best = p.db > best + 0.5; // less is chance
        best = Math.max(best, p.db);
    }
    return points;
}
function show_frontier() {
    const points = points_of(shown.board), best = points.filter(p => p.best);
    const c = cost(shown.board, 'q32') ?? {}, scenes = Object.keys(data.costs[shown.board].q32?.rays ?? {});
    const {mhz, name} = data.parts[shown.board], colour = number => `--number: var(--${number}, var(--other))`;
    if (document.activeElement !== $('clock'))
        $('clock').value = clock();
    $('source').textContent = 'Instructions: the rays of this picture times '
        + (c.own ? `the instructions a ray that the study measured for scenes/${shown.scene}.nff with one sample.`
                 : 'the study\'s instructions a ray, of which this scene has none of its own: the mean of '
                   + `${scenes.join(', ')}, which lie from ${spaced(c.low)} to ${spaced(c.high)} in q32. `
                   + 'Take it as a first guess; make plan measures.')
        + ' Rays of what is worth choosing are counted on the whole picture; until they are (≈), and of the hollow '
        + `points, on ${spaced(surveyed_pixels)} pixels that lie evenly over it.`
        + ` Time: at ${clock()} MHz${clock() === mhz ? ` (${name})` : ''}, `
        + (c.cycles === 1 ? 'a cycle an instruction'
                          : `${c.cycles.toFixed(2)} cycles an instruction in q32, as the study models this core`)
        + ', and memory that never waits.'
        + ` Accuracy: of those pixels, against double with ${truth.samples} samples and depth ${truth.depth}.`;
    $('plot').replaceChildren(
        points.length > 1 ? plot(points) : element('p', {
            className: 'hint', textContent: 'Points appear when both pictures are drawn.'}),
        element('p', {className: 'key'}, ...[...new Set(points.map(p => p.settings.number))].map(number =>
            element('span', {textContent: number, style: colour(number)}))));
    $('points').replaceChildren(...best.map(p => element('li', {style: colour(p.settings.number)}, element('button', {
        type: 'button', className: same(p.settings, chosen_point) ? 'now' : '', onclick: () => choose_point(p),
    }, ...[describe_settings(p.settings), `${p.db.toFixed(1)} dB`,
           `${p.exact ? '' : '≈ '}${short(p.instructions)} instr.`, duration(p.seconds)].map(textContent =>
               element('span', {textContent}))))));
    const now = points.find(p => same(p.settings, chosen_point));
    if (now !== undefined)
        show_chosen(now);
}
const same = (p, q) => JSON.stringify(p) === JSON.stringify(q);
function plot(points) {
    const w = Math.max(300, $('plot').clientWidth), h = Math.min(360, Math.round(w * .72));
    const left = 44, bottom = 40, top = 10, right = 14;
    const xs = points.map(p => Math.log10(p.instructions)), ys = points.map(p => p.db);
    const [x0, x1] = [Math.min(...xs) - .1, Math.max(...xs) + .35];
    const [y0, y1] = [Math.min(...ys) - 1.5, Math.max(...ys) + 1.5];
    const x = p => left + (Math.log10(p) - x0) / (x1 - x0) * (w - left - right);
    const y = db => top + (y1 - db) / (y1 - y0) * (h - top - bottom);
    const svg = drawn('svg', {viewBox: `0 0 ${w} ${h}`, role: 'group', 'aria-label': 'Accuracy against instructions'});
    for (let e = Math.floor(x0); e <= x1; e++)
        for (const n of (x1 - x0 < 2.2 ? [1, 2, 5] : [1]).map(k => k * 10 ** e))
            if (Math.log10(n) >= x0 && Math.log10(n) <= x1)
                svg.append(drawn('line', {class: 'grid', x1: x(n), x2: x(n), y1: top, y2: h - bottom}),
                           drawn('text', {x: x(n), y: h - bottom + 16, 'text-anchor': 'middle'},
                                 short(n).replace(/\.0+\b/, '')));
    const step = y1 - y0 > 30 ? 10 : y1 - y0 > 12 ? 5 : 2;
    for (let db = Math.ceil(y0 / step) * step; db <= y1; db += step)
        svg.append(drawn('line', {class: 'grid', x1: left, x2: w - right, y1: y(db), y2: y(db)}),
                   drawn('text', {x: left - 6, y: y(db) + 4, 'text-anchor': 'end'}, String(db)));
    svg.append(drawn('text', {x: w - right, y: h - 4, 'text-anchor': 'end'},
                     `instructions a picture, ${data.boards[shown.board]}`),
               drawn('text', {x: 0, y: top + 4}, 'dB'));
    const front = points.filter(p => p.best);
    svg.append(drawn('path', {class: 'front', d: front.map((p, i) =>
        i === 0 ? `M${x(p.instructions)} ${y(p.db)}` : `H${x(p.instructions)}V${y(p.db)}`).join('')}));
    const marked = [];
    for (const p of [...points.filter(p => !p.best), ...front]) {
        const name = describe_settings(p.settings);
        const told = `${name}: ${p.db.toFixed(1)} dB, ${short(p.instructions)} instructions`;
        const group = drawn('g', {class: `point${p.best ? ' best' : ''}${same(p.settings, chosen_point) ? ' now' : ''}`,
                                  style: `--number: var(--${p.settings.number}, var(--other))`,
                                  role: 'button', tabindex: 0, 'aria-label': told},
                            drawn('title', {}, told),
                            drawn('circle', {cx: x(p.instructions), cy: y(p.db), r: p.best ? 5 : 4}));
        // A name goes where there is room, or to the list alone.
        const at = [x(p.instructions) + 8, y(p.db) + 15];
        if (p.best && !marked.some(m => Math.abs(m[0] - at[0]) < 100 && Math.abs(m[1] - at[1]) < 13)) {
            group.append(drawn('text', {x: at[0], y: at[1]}, name.replace(' samples', '×').replace('adaptive ', 'a')));
            marked.push(at);
        }
        group.onclick = () => choose_point(p);
        group.onkeydown = e => {
            if (e.key === 'Enter' || e.key === ' ') {
                e.preventDefault();
                choose_point(p);
            }
        };
        svg.append(group);
    }
    return svg;
}
function run_line(s, built) {
    const differs = (name, value) => value === undefined ? '' : ` ${name}=${value}`;
    const adaptive = s.threshold === 1 / 16 ? s.levels : `${s.levels},${s.threshold}`;
    return `make run SCENE=${scene_file()} NUMBER=${s.number} BOARD=${shown.board} SIZE=${built.width}x${built.height}`
        + differs('SAMPLES', s.levels === 0 && s.samples !== 1 ? s.samples : undefined)
        + differs('ADAPTIVE', s.levels === 0 ? undefined : adaptive)
        + differs('DEPTH', s.depth !== drawing.depth ? s.depth : undefined)
        + differs('CUTOFF', s.cutoff !== drawing.cutoff ? s.cutoff : undefined);
}
function show_chosen(p) {
    chosen_point = p?.settings ?? null;
    $('run').hidden = false;
    $('chosen').textContent = p === null ? 'Picture A on this board:'
        : `Picture A, ${describe_settings(p.settings)}: ${p.db.toFixed(1)} dB for ${short(p.instructions)} `
          + `instructions, ${duration(p.seconds)} (${p.exact ? '' : 'about '}${spaced(p.rays)} rays).`
          + ' Picture B is what it is measured against.';
    show_run();
}
function show_run() {
    const [width, height] = picture_size();
    $('run').textContent = run_line(shown.sides[0], sides[0].built ?? {width: width || 320, height: height || 240})
        + (is_changed() ? '\n# with the text saved as scene.nff' : '');
}
function choose_point(p) {
    Object.assign(shown.sides[0], p.settings);
    const drawn_already = same(shown.sides[1], truth);
    Object.assign(shown.sides[1], truth);
    show_chosen(p);
    show_frontier();
    sides[0].draw();
    if (!drawn_already || !sides[1].done)
        sides[1].draw();
}

// A link holds all that is shown.
let link_timer = 0;
function save_link() {
    clearTimeout(link_timer);
    link_timer = setTimeout(() => {
        const {scene, text, ...rest} = shown, kept = is_changed() ? {scene, text, ...rest} : {scene, ...rest};
        history.replaceState(null, '', `#${encodeURIComponent(JSON.stringify(kept))}`);
        $('save').href = `data:text/plain;charset=utf-8,${encodeURIComponent(shown.text)}`;
    }, 200);
}
let link_mistakes = [];
function read_link() {
    link_mistakes = [];
    if (location.hash.length < 2)
        return;
    try {
        const kept = JSON.parse(decodeURIComponent(location.hash.slice(1)));
        const one_of = all => ({able: v => all.includes(v), expected: `one of ${all.join(', ')}`});
        const take = (from, to, key, {able, expected}, of = '') => {
            const value = from?.[key];
            if (value === undefined)
                return;
            if (typeof value === typeof (to[key] ?? 0) && able(value))
                to[key] = value;
            else
                link_mistakes.push(`The link has ${key} ${JSON.stringify(value).slice(0, 40)}${of}; `
                                   + `expected ${expected}.`);
        };
        take(kept, shown, 'scene', one_of(Object.keys(data.scenes)));
        shown.text = typeof kept.text === 'string' ? kept.text : data.scenes[shown.scene];
        take(kept, shown, 'size', one_of(sizes));
        take(kept, shown, 'board', one_of(Object.keys(data.boards)));
        shown.clock = null;
        if (kept.clock !== null)
            take(kept, shown, 'clock', {able: v => v >= 0.001 && v <= 1e5, expected: 'MHz from 0.001 to 100000'});
        shown.sides.forEach((side, i) => {
            for (const key of Object.keys(drawing))
                take(kept.sides?.[i], side, key, dials[key] ?? one_of(told.numbers), ` for picture ${'AB'[i]}`);
        });
    } catch {
        link_mistakes.push('The link is none of this page.');
    }
}

const sizes = ['80x60', '160x120', '320x240', '640x480', 'scene'];
let sides = [];
function draw_all() {
    compared = chosen_pixel = null;
    survey_key = null;
    surveyor.stop();
    found = [];
    show_chosen(null);
    show_frontier();
    sides.forEach(side => side.draw());
}
function show_all() {
    $('text').value = shown.text;
    $('load').value = shown.scene;
    $('size').value = shown.size;
    $('board').value = shown.board;
    draw_all();
}
let typing = 0;
function set_text(text, pause) {
    shown.text = text;
    link_mistakes = [];
    state('drawing');
    for (const tracer of [judge, surveyor, ...sides.map(side => side.tracer)])
        tracer.stop();
    clearTimeout(typing);
    typing = setTimeout(draw_all, pause);
}

async function start() {
    const stream = new Blob([unpacked(data.wasm)]).stream().pipeThrough(new DecompressionStream('gzip'));
    const compiled = await WebAssembly.compile(await new Response(stream).arrayBuffer());
    const {exports: wasm} = await WebAssembly.instantiate(compiled, {page: {size: () => -1, read: () => {}}});
    const all = new Uint8Array(wasm.memory.buffer), at = wasm.describe();
    told = JSON.parse(new TextDecoder().decode(all.subarray(at, all.indexOf(0, at))));
    module = compiled;
    worker_url = URL.createObjectURL(new Blob([$('worker').textContent], {type: 'text/javascript'}));
    read_link();

    $('load').append(...Object.keys(data.scenes).map(name => new Option(name, name)));
    const size_name = size => size === 'scene' ? 'as the text says' : size.replace('x', ' × ');
    $('size').append(...sizes.map(size => new Option(size_name(size), size)));
    $('board').append(...Object.entries(data.boards).map(([board, label]) => new Option(`${label} (${board})`, board)));
    sides = [new Side(0), new Side(1)];
    $('pictures').append(...sides.map(side => side.root));
    choose_pixels($('map'));
    $('why').ontoggle = show_pixel;
    $('worst').onclick = () => compared !== null && choose(...worst_pixel());
    show_scale();

    $('text').oninput = () => set_text($('text').value, 250);
    $('load').onchange = () => {
        shown.scene = $('load').value;
        $('text').value = data.scenes[shown.scene];
        $('text').scrollTop = 0;
        set_text($('text').value, 0);
    };
    $('size').onchange = () => {
        shown.size = $('size').value;
        draw_all();
    };
    $('board').onchange = () => {
        shown.board = $('board').value;
        shown.clock = null;
        show_chosen(null);
        show_frontier();
        count_rays();
        save_link();
    };
    $('clock').onchange = () => {
        shown.clock = $('clock').value > 0 ? +$('clock').value : null;
        show_frontier();
        save_link();
    };
    $('places').oninput = () => {
        $('places-dial').querySelector('output').textContent = $('places').value;
        $('text').value = shown.text.replace(/^([ \t]*panel[ \t]+)\d+/gm, `$1${$('places').value}`);
        set_text($('text').value, 250);
    };
    $('link').onclick = async () => {
        await new Promise(later => setTimeout(later, 250));
        await navigator.clipboard?.writeText(location.href).catch(() => {});
        $('link').textContent = navigator.clipboard === undefined ? 'The address holds it' : 'Copied';
        setTimeout(() => $('link').textContent = 'Copy a link to this', 1500);
    };
    let width = innerWidth;
    onresize = () => {
        if (width !== innerWidth) // not where a phone's bars come and go
            show_frontier();
        width = innerWidth;
    };
    onhashchange = () => {
        read_link();
        show_all();
    };
    show_all();
}
start().catch(error => show_message(`This page does not start here: ${error.message}. `
                                    + 'It wants a browser of 2023 or later.', true));
