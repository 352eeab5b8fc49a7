// Scene files of pbrt in VS Code: `whit lsp` knows the language, this file starts it, shows `whit watch` beside the
// text, and runs `whit check` as a task.
'use strict';

const { spawn } = require('child_process');
const vscode = require('vscode');
const { LanguageClient } = require('vscode-languageclient/node');

/** How long `whit watch` may take to say its address. */
const WATCH_START_MS = 20000;

let client;
let output;
/** The running `whit watch` of each file, by path. */
const previews = new Map();

function settings(uri) {
  return vscode.workspace.getConfiguration('whit', uri);
}

/** The program: a path with a folder in it is taken from the workspace's. */
function programPath(uri) {
  const path = settings(uri).get('path') || 'whit';
  const folder = uri && vscode.workspace.getWorkspaceFolder(uri);
  return folder ? path.replace('${workspaceFolder}', folder.uri.fsPath) : path;
}

/** Runs the program, and resolves to "" when it can be started, else to why not. */
function whyNotRunning(program) {
  return new Promise((resolve) => {
    const child = spawn(program, ['--version'], { stdio: 'ignore' });
    child.on('error', (error) => resolve(error.code === 'ENOENT' ? 'there is no such program' : error.message));
    child.on('exit', (code) => resolve(code === 0 ? '' : `it ended with exit code ${code}`));
  });
}

async function sayNotFound(program, why) {
  const open = 'Open Settings';
  const chosen = await vscode.window.showErrorMessage(
    `whit cannot be started as "${program}": ${why}. Install it, or set whit.path to where it is.`, open);
  if (chosen === open) await vscode.commands.executeCommand('workbench.action.openSettings', 'whit.path');
}

async function startServer() {
  const program = programPath();
  const why = await whyNotRunning(program);
  if (why) {
    sayNotFound(program, why);
    return;
  }
  const started = new LanguageClient('whit', 'whit', { command: program, args: ['lsp'] }, {
    documentSelector: [{ scheme: 'file', language: 'pbrt' }, { scheme: 'untitled', language: 'pbrt' }],
    synchronize: { fileEvents: vscode.workspace.createFileSystemWatcher('**/*.{pbrt,ply,gltf,glb,png,exr,spd}') },
    outputChannel: output,
  });
  client = started;
  try {
    await started.start();
  } catch (error) {
    vscode.window.showErrorMessage(`whit's language server has not started: ${error.message}`);
  }
}

async function stopServer() {
  const stopped = client;
  client = undefined;
  if (stopped) await stopped.stop().catch(() => {});
}

/** The address in what `whit watch` has printed so far, or undefined. */
function addressIn(text) {
  const found = /https?:\/\/(?:127\.0\.0\.1|localhost|\[::1\]):\d+\S*(?=\s)/.exec(text);
  return found ? found[0] : undefined;
}

/** Starts `whit watch`, and resolves to its address once it has said it. */
function startWatch(file, uri) {
  const program = programPath(uri);
  const extra = settings(uri).get('previewArguments') || [];
  const child = spawn(program, ['watch', file, ...extra]);
  const preview = { child, address: undefined };
  previews.set(file, preview);
  child.stderr.on('data', (data) => output.append(data.toString()));
  return new Promise((resolve, reject) => {
    let printed = '';
    const fail = (error) => {
      clearTimeout(timer);
      if (previews.get(file) === preview) previews.delete(file);
      reject(error);
    };
    const timer = setTimeout(() => {
      child.kill();
      fail(new Error('it has not said its address'));
    }, WATCH_START_MS);
    child.on('error', fail);
    child.on('close', (code) => fail(new Error(`it ended with exit code ${code}`)));
    child.stdout.on('data', (data) => {
      printed += data.toString();
      preview.address = preview.address || addressIn(printed);
      if (!preview.address) return;
      clearTimeout(timer);
      resolve(preview.address);
    });
  });
}

/** The scene that a command is about: where it was called, or else the active editor. */
async function savedScene(uri) {
  const editor = vscode.window.activeTextEditor;
  const document = uri ? await vscode.workspace.openTextDocument(uri) : editor && editor.document;
  if (!document || document.languageId !== 'pbrt' || document.uri.scheme !== 'file') {
    vscode.window.showErrorMessage('whit: open a .pbrt file first, one that is saved in a folder.');
    return undefined;
  }
  if (document.isDirty) await document.save();
  return document.uri;
}

async function preview(uri) {
  const scene = await savedScene(uri);
  if (!scene) return;
  const running = previews.get(scene.fsPath);
  try {
    const address = (running && running.address) || await startWatch(scene.fsPath, scene);
    await vscode.commands.executeCommand('simpleBrowser.api.open', vscode.Uri.parse(address, true),
      { viewColumn: vscode.ViewColumn.Beside, preserveFocus: true });
  } catch (error) {
    const program = programPath(scene);
    const why = await whyNotRunning(program);
    if (why) sayNotFound(program, why);
    else vscode.window.showErrorMessage(`whit watch cannot show ${scene.fsPath}: ${error.message}.`);
    output.show(true);
  }
}

async function check(uri) {
  const scene = await savedScene(uri);
  if (!scene) return;
  const folder = vscode.workspace.getWorkspaceFolder(scene) || vscode.TaskScope.Workspace;
  const run = new vscode.ProcessExecution(programPath(scene), ['check', scene.fsPath]);
  const task = new vscode.Task({ type: 'whit' }, folder, 'check', 'whit', run, '$whit');
  await vscode.tasks.executeTask(task);
}

function stopPreviews() {
  for (const { child } of previews.values()) child.kill();
  previews.clear();
}

async function activate(context) {
  output = vscode.window.createOutputChannel('whit');
  context.subscriptions.push(
    output,
    { dispose: stopPreviews },
    vscode.commands.registerCommand('whit.preview', preview),
    vscode.commands.registerCommand('whit.check', check),
    vscode.workspace.onDidChangeConfiguration(async (change) => {
      if (!change.affectsConfiguration('whit.path')) return;
      await stopServer();
      await startServer();
    }));
  await startServer();
}

async function deactivate() {
  stopPreviews();
  await stopServer();
}

module.exports = { activate, deactivate, addressIn };
