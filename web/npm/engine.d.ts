/** Types of engine.js, which says at its top what each means. */
export interface EngineSource {
  factory?: (options: object) => Promise<unknown>;
  wasm?: ArrayBuffer | Uint8Array | WebAssembly.Module;
}
export interface RunOptions {
  onStdout?: (line: string) => void;
  onStderr?: (line: string) => void;
  onPlan?: (text: string) => void;
  isStopped?: () => boolean;
  stdin?: Uint8Array | string | (() => Uint8Array | string);
  umask?: number;
  takeStdout?: (bytes: Uint8Array) => unknown;
  takeStderr?: (bytes: Uint8Array) => unknown;
  mount?: (FS: unknown) => string;
}
export interface RunResult {
  /** 0 done, 2 usage, 3 bad input, 4 infeasible, 5 not proved (plan written), 70 fault */
  exit: number;
  stdout: string;
  stderr: string;
  /** files that the command made or changed, by name */
  files: Record<string, Uint8Array>;
}
export interface Engine {
  /** One command line, without the word `thread`, on these files. */
  run(args: string[], files?: Record<string, Uint8Array | string>, options?: RunOptions): Promise<RunResult>;
}
/** Under node the source may be left out. */
export function makeEngine(source?: EngineSource): Promise<Engine>;
