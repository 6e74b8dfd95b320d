// A thread of the page with a tracer of its own. A job has an id; a later one ends those before it, between two slices.
'use strict';
const slice = 40; // ms
const most = 256 << 20; // bytes, then another instance
let module, files, wasm = null, text = null, solved = false, latest = 0;

const bytes = (at, size) => new Uint8Array(wasm.memory.buffer, at, size);
const string = at => {
    const all = new Uint8Array(wasm.memory.buffer);
    return new TextDecoder().decode(all.subarray(at, all.indexOf(0, at)));
};
const named = name => {
    const code = new TextEncoder().encode(name).subarray(0, 255), at = wasm.name_room();
    bytes(at, 256).fill(0).set(code);
    return at;
};
const answer = at => JSON.parse(string(at));

// Lets messages in.
const channel = new MessageChannel();
const breath = () => new Promise(go => {
    channel.port1.onmessage = go;
    channel.port2.postMessage(0);
});
class Stopped extends Error {}

function begin() {
    if (wasm !== null && wasm.memory.buffer.byteLength < most)
        return;
    wasm = new WebAssembly.Instance(module, {page: {
        size: name => files[string(name)]?.length ?? -1,
        read: (name, to) => bytes(to, files[string(name)].length).set(files[string(name)]),
    }}).exports;
    text = null;
}

// What is wrong stops a job, and goes to the page.
function checked(result) {
    if (result.error !== undefined)
        throw new Stopped(result.error);
    return result;
}

function read(job) {
    begin();
    if (text === job.text)
        return read.scene;
    text = null;
    const code = new TextEncoder().encode(job.text);
    bytes(wasm.text_room(code.length), code.length).set(code);
    read.scene = checked(answer(wasm.parse(named(job.name), code.length)));
    if (read.scene.radiosity) {
        postMessage({id: job.id, solving: true});
        checked(answer(wasm.solve()));
        postMessage({id: job.id, solving: false});
    }
    text = job.text;
    return read.scene;
}

function build(job, s) {
    return checked(answer(wasm.build(named(s.number), job.width, job.height, s.levels === 0 ? Math.sqrt(s.samples) : 1,
                                     s.levels, s.threshold, s.depth, s.cutoff)));
}

const rays = () => [0, 1, 2, 3].map(kind => wasm.ray_count(kind));
const all_rays = () => rays().reduce((a, b) => a + b);

// Calls part(i) for all i below count, and between slices rest(next i, ms so far); ms.
async function in_slices(job, count, part, rest = () => {}) {
    let time = 0;
    for (let i = 0; i < count;) {
        const start = performance.now();
        do
            part(i++);
        while (i < count && performance.now() - start < slice);
        time += performance.now() - start;
        rest(i, time);
        await breath();
        if (job.id !== latest)
            throw null;
    }
    return time;
}

const jobs = {
    async draw(job) {
        const scene = read(job), built = build(job, job.settings), row = 3 * built.width;
        postMessage({id: job.id, scene, built});
        let first = 0, at = 0;
        const time = await in_slices(job, built.height, y => {
            const to = wasm.row(y);
            at = y === 0 ? to : at;
        }, (next, ms) => {
            const rgb = bytes(at + first * row, (next - first) * row).slice();
            postMessage({id: job.id, first, rgb, part: next / built.height, ms}, [rgb.buffer]);
            first = next;
        });
        postMessage({id: job.id, done: true, ms: time, rays: rays()});
    },

    async compare(job) {
        begin();
        const pixels = job.width * job.height, at = wasm.room_for_two(pixels);
        bytes(at, 3 * pixels).set(job.a);
        bytes(at + 3 * pixels, 3 * pixels).set(job.b);
        const figures = answer(wasm.compare(job.width, job.height));
        const map = bytes(at + 6 * pixels, pixels).slice();
        postMessage({id: job.id, figures, map}, [map.buffer]);
    },

    // Why a pixel has its colour, where a is drawn so, and beside it b.
    async explain(job) {
        read(job);
        for (const [which, s] of job.settings.entries()) {
            build(job, s);
            wasm.explain(which, job.x, job.y);
        }
        postMessage({id: job.id, text: string(wasm.explanation(job.settings.length))});
    },

    // Scattered pixels of each setting, against those of the first.
    async frontier(job) {
        read(job);
        let truth = null, done = 0;
        const work = s => s.levels === 0 ? s.samples : 3 * s.levels;
        const all = job.settings.reduce((sum, s) => sum + work(s), 0);
        for (const s of job.settings) {
            let built;
            try {
                built = build(job, s);
            } catch (error) {
                if (error instanceof Stopped && truth !== null) {
                    postMessage({id: job.id, settings: s, unfit: error.message});
                    continue;
                }
                throw error;
            }
            // A small picture is drawn whole.
            const pixels = built.width * built.height, exact = pixels <= job.pixels;
            const parts = exact ? built.height : Math.min(built.combs, Math.ceil(job.pixels / built.length));
            const size = 3 * (exact ? built.width : built.length) * parts;
            let at = 0;
            await in_slices(job, parts, k => {
                const to = exact ? wasm.row(k) : wasm.comb(k);
                at = k === 0 ? to : at;
            }, k => postMessage({id: job.id, part: (done + work(s) * k / parts) / all}));
            done += work(s);
            const rgb = bytes(at, size).slice();
            truth ??= rgb;
            let squares = 0;
            for (let i = 0; i < size; i++)
                squares += (rgb[i] - truth[i]) ** 2;
            if (rgb !== truth)
                postMessage({id: job.id, settings: s, exact, rays: all_rays() * 3 * pixels / size,
                             error: squares / size});
        }
        postMessage({id: job.id, done: true});
    },

    // Rays of the whole picture.
    async count(job) {
        read(job);
        const {height} = build(job, job.settings);
        await in_slices(job, height, y => wasm.row(y), y => postMessage({id: job.id, part: y / height}));
        postMessage({id: job.id, rays: all_rays()});
    },
};

onmessage = async ({data: job}) => {
    if (job.module !== undefined) {
        ({module, files} = job);
        return;
    }
    latest = job.id;
    try {
        await jobs[job.kind](job);
    } catch (error) {
        if (error === null) // a later job is on its way
            return;
        if (!(error instanceof Stopped)) // a trap: nothing of that instance is to be trusted
            wasm = null;
        const message = error instanceof Stopped ? error.message : `the tracer stopped: ${error.message}`;
        postMessage({id: job.id, failed: message});
    }
};
