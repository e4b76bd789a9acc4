// The studio's server for a script or test: STUDIO_PYTHON names the Python that has plica.studio.
import { spawn } from "node:child_process";

export const python = process.env.STUDIO_PYTHON;

/** Serve a folder, or a scenario in it; `stop(signal)` ends the server and waits for its end. */
export async function serve(folder, scenario = ".") {
  const server = spawn(python, ["-m", "plica.studio", scenario, "--no-browser", "--threads", "1"],
    { cwd: folder, stdio: ["ignore", "pipe", "inherit"] });
  const ended = new Promise((done) => server.once("exit", done));
  const url = await new Promise((found, fail) => {
    let text = "";
    server.stdout.on("data", (data) => {
      text += data;
      const address = /http\S+/.exec(text);
      if (address) found(address[0]);
    });
    server.on("exit", (status) => fail(new Error(`plica.studio ended with ${status}`)));
  });
  const stop = (signal) => {
    server.kill(signal);
    return ended;
  };
  return { url, stop, pid: server.pid };
}
