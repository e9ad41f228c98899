// Compiles what `cargo xtask shaders FILE` wrote by Dawn and Tint, the compiler of Chrome, without a graphics driver.
// Every error and every warning counts: `node check.mjs FILE` ends with 1 if there is any.
import { readFileSync } from 'node:fs';
import { create, globals } from 'webgpu';

Object.assign(globalThis, globals);
const { modules, passes } = JSON.parse(readFileSync(process.argv[2], 'utf8'));
// Kept to the end: what is collected takes its device along.
globalThis.gpu = create(['backend=null']);
const adapter = await gpu.requestAdapter();
const device = await adapter.requestDevice();

let wrong = 0;
const report = (name, text) => {
  wrong += 1;
  console.log(`${name}: ${text}`);
};

/** The file and the line of a line of a composed text. */
function place(text, line) {
  const lines = text.split('\n').slice(0, line);
  const start = lines.findLastIndex((each) => each.startsWith('// ---- '));
  return start < 0 ? `line ${line}` : `${lines[start].slice(8)}:${line - start - 1}`;
}

/** Reports what `make` raises. */
async function checked(name, make) {
  device.pushErrorScope('validation');
  device.pushErrorScope('internal');
  try {
    await make();
  } catch (error) {
    report(name, error.message);
  }
  for (let scope = 0; scope < 2; scope += 1) {
    const error = await device.popErrorScope();
    if (error) report(name, error.message);
  }
}

/** A shader module, or none if its text is wrong; its messages are reported with their places. */
async function compiled(name, text) {
  device.pushErrorScope('validation');
  const module = device.createShaderModule({ label: name, code: text });
  const { messages } = await module.getCompilationInfo();
  const error = await device.popErrorScope();
  for (const { type, lineNum, message } of messages) {
    // Information belongs to the error before it.
    if (type === 'info') console.log(`  ${place(text, lineNum)}: ${message}`);
    else report(name, `${type}, ${place(text, lineNum)}: ${message}`);
  }
  if (error && messages.length === 0) report(name, error.message);
  return error ? null : module;
}

const texts = new Map();
for (const { name, text } of [...modules, ...passes]) {
  if (!texts.has(text)) texts.set(text, await compiled(name, text));
}
for (const { name, text, entry, constants, groups } of passes) {
  const module = texts.get(text);
  if (!module) continue;
  await checked(`${name} (${entry})`, () => {
    const bindGroupLayouts = groups?.map((entries) => device.createBindGroupLayout({ entries }));
    const layout = groups ? device.createPipelineLayout({ bindGroupLayouts }) : 'auto';
    return device.createComputePipelineAsync({ label: name, layout, compute: { module, entryPoint: entry, constants } });
  });
}
console.log(`${modules.length} modules, ${passes.length} passes: ${wrong} errors and warnings`);
process.exit(wrong > 0 ? 1 : 0);
