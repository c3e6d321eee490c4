// The engine in a thread of its own: one request at a time, each with progress messages.
let engine = null;

function text(at, length) {
  return new TextDecoder().decode(new Uint8Array(engine.memory.buffer, at, length));
}

const host = {
  // "share<tab>message"; the share is empty if the message is not a step.
  tell(at, length) {
    const [share, what] = text(at, length).split("\t");
    postMessage({ what, share: share === "" ? null : Number(share) });
  },
  fault(at, length) {
    postMessage({ fault: text(at, length) });
  },
  now: () => performance.now() / 1000,
};

async function start(program) {
  const made = await WebAssembly.instantiate(program, { host });
  engine = (made.instance ?? made).exports;
}

// A line of JSON, then the bytes of a file.
function ask(request, bytes) {
  const line = new TextEncoder().encode(JSON.stringify(request) + "\n");
  const length = line.length + (bytes ? bytes.byteLength : 0);
  const at = engine.room(length);
  const room = new Uint8Array(engine.memory.buffer, at, length);
  room.set(line);
  if (bytes) room.set(new Uint8Array(bytes), line.length);
  const answered = engine.ask();
  const answer = new Uint8Array(engine.memory.buffer, engine.answer_at(), answered).slice();
  const end = answer.indexOf(10);
  const json = JSON.parse(new TextDecoder().decode(answer.subarray(0, end)));
  const files = {};
  let from = end + 1;
  for (const [name, size] of json.files) {
    files[name] = answer.slice(from, from + size);
    from += size;
  }
  json.files = files;
  return json;
}

onmessage = async ({ data }) => {
  try {
    if (data.program) await start(data.program);
    else postMessage({ id: data.id, answer: ask(data.request, data.bytes) });
  } catch (error) {
    postMessage({ id: data.id, stopped: String(error) });
  }
};
