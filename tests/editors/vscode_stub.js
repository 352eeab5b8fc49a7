// Runs the extension for VS Code with stand-ins for `vscode` and `vscode-languageclient`, as the steps in argv[2] (JSON)
// say, and prints what it did as JSON. Steps: {"command": NAME}, {"set": {KEY: VALUE}}, {"wait": MILLISECONDS}.
'use strict';

const Module = require('module');
const path = require('path');

const did = { errors: [], clients: [], executed: [], tasks: [], output: '' };
const { steps, settings, file, language } = JSON.parse(process.argv[2]);
const commands = new Map();
let configurationListener = () => {};

const uriOf = (fsPath) => ({ scheme: 'file', fsPath, toString: () => `file://${fsPath}` });
const document = { uri: uriOf(file), languageId: language, isDirty: true, save: async () => { did.saved = true; } };

const vscode = {
  ViewColumn: { Beside: -2 },
  TaskScope: { Workspace: 2 },
  Uri: { parse: (text) => ({ text }), file: uriOf },
  ProcessExecution: class { constructor(program, args) { Object.assign(this, { program, args }); } },
  Task: class {
    constructor(definition, scope, name, source, execution, matchers) {
      Object.assign(this, { definition, name, source, execution, matchers });
    }
  },
  workspace: {
    getConfiguration: () => ({ get: (key) => settings[key] }),
    getWorkspaceFolder: () => ({ uri: uriOf(path.dirname(file)) }),
    createFileSystemWatcher: () => ({}),
    openTextDocument: async () => document,
    onDidChangeConfiguration: (listener) => { configurationListener = listener; return { dispose() {} }; },
  },
  window: {
    activeTextEditor: { document },
    createOutputChannel: () => ({ append: (text) => { did.output += text; }, show() {}, dispose() {} }),
    showErrorMessage: async (message, ...choices) => { did.errors.push(message); return choices[0]; },
  },
  commands: {
    registerCommand: (name, run) => { commands.set(name, run); return { dispose() {} }; },
    executeCommand: async (...args) => { did.executed.push(args); },
  },
  tasks: { executeTask: async (task) => { did.tasks.push(task); } },
};

class LanguageClient {
  constructor(id, name, server, options) {
    this.record = { id, command: server.command, args: server.args, languages: options.documentSelector, stopped: false };
    did.clients.push(this.record);
  }
  async start() { this.record.started = true; }
  async stop() { this.record.stopped = true; }
}

const load = Module._load;
Module._load = function (name, ...rest) {
  if (name === 'vscode') return vscode;
  if (name === 'vscode-languageclient/node') return { LanguageClient };
  return load.call(this, name, ...rest);
};

async function main() {
  const extension = require(path.join(__dirname, '../../tools/editors/vscode/extension.js'));
  await extension.activate({ subscriptions: [] });
  did.commands = [...commands.keys()].sort();
  for (const step of steps) {
    if (step.command) await commands.get(step.command)();
    if (step.wait) await new Promise((resolve) => setTimeout(resolve, step.wait));
    if (step.set) {
      Object.assign(settings, step.set);
      await configurationListener({ affectsConfiguration: (key) => key.replace('whit.', '') in step.set });
    }
  }
  await extension.deactivate();
  console.log(JSON.stringify(did));
}

main().catch((error) => { console.error(error); process.exit(1); });
