// The program in a worker: one command after another, each with the files that it works on.
let engine;

onmessage = async ({data}) => {
  if (data.module) {
    engine = makeEngine({factory: ThreadEngine, wasm: data.module});
    return;
  }
  const {id, args, files} = data;
  const result = await (await engine).run(args, files, {
    onStderr: (line) => postMessage({id, line}),
    onPlan: (plan) => postMessage({id, plan}),
  });
  postMessage({id, result});
};
