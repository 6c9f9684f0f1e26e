// Runs viser's program (app/bridge/program.py) once what it decompresses messages with is ready.
const address = (name) => document.querySelector(`link[data-${name}]`).href;

globalThis.__viserZstdWasm = await WebAssembly.compileStreaming(fetch(address("zstd")));
await import(address("program"));
