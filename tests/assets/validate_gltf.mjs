// Runs the Khronos glTF validator (npm: gltf-validator) over files: node validate_gltf.mjs FILE...
// CHIARO_GLTF_VALIDATOR names the node_modules folder that holds it. Exit 0: no errors; 1: errors; 77: no validator.
import { readFileSync } from 'node:fs';
import { createRequire } from 'node:module';
import { dirname, join, resolve } from 'node:path';

const folder = process.env.CHIARO_GLTF_VALIDATOR;
if (!folder) {
  console.log('skipped: CHIARO_GLTF_VALIDATOR does not name a node_modules folder (npm install gltf-validator)');
  process.exit(77);
}
let validator;
try {
  validator = createRequire(join(resolve(folder), 'anything.js'))('gltf-validator');
} catch (error) {
  console.log(`skipped: no gltf-validator in ${folder} (${error.code})`);
  process.exit(77);
}

const severities = ['error', 'warning', 'info', 'hint'];
const files = process.argv.slice(2);
let failed = files.length === 0;
if (failed) console.log('usage: node validate_gltf.mjs FILE...');
for (const file of files) {
  const report = await validator.validateBytes(new Uint8Array(readFileSync(file)), {
    uri: file,
    maxIssues: 1000,
    externalResourceFunction: (uri) => Promise.resolve(new Uint8Array(readFileSync(join(dirname(file), decodeURIComponent(uri))))),
  });
  const { numErrors, numWarnings, numInfos, messages } = report.issues;
  console.log(`${file}: ${numErrors} errors, ${numWarnings} warnings, ${numInfos} infos`);
  for (const message of messages.filter((m) => m.severity <= 1).slice(0, 20))
    console.log(`  ${severities[message.severity]} ${message.code} at ${message.pointer}: ${message.message}`);
  failed ||= numErrors > 0;
}
process.exit(failed ? 1 : 0);
