// Builds the one page that the program puts plans into: `node build.mjs > viewer_page.html`. esbuild makes one classic script
// of the modules, because browsers load no modules from file:// addresses.
import {build} from 'esbuild';
import {readFileSync} from 'node:fs';
import {fileURLToPath} from 'node:url';

const read = (name) => readFileSync(new URL(name, import.meta.url), 'utf8').trimEnd();
const built = await build({
  absWorkingDir: fileURLToPath(new URL('.', import.meta.url)),
  entryPoints: ['main.js'],
  bundle: true,
  format: 'iife',
  minify: true,
  write: false,
  target: ['es2020'],
  legalComments: 'none',
  charset: 'utf8',
});
const script = built.outputFiles[0].text.trimEnd();
if (/<\/script|<!--|@PLAN@/i.test(script)) throw new Error('the script holds text that would end it');
const parts = {STYLE: read('style.css'), LICENSE: read('LICENSE-three.txt'), SCRIPT: script};
process.stdout.write(read('page.html').replace(/@(STYLE|LICENSE|SCRIPT)@/g, (_, name) => parts[name]) + '\n');
