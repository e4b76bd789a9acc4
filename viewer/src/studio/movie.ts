// Recording of the pictures as they are replayed: MP4 where the browser writes it, else WebM.
const perSecond = 25;
const kinds: [string, string][] = [["video/mp4", "mp4"], ["video/webm", "webm"]];

/** Record the canvases of `holder` side by side while `goesOn` holds. */
export async function movieOf(holder: HTMLElement, goesOn: () => boolean): Promise<{ name: string; content: Blob }> {
  const kind = kinds.find(([type]) => typeof MediaRecorder !== "undefined" && MediaRecorder.isTypeSupported(type));
  if (!kind) throw new Error("this browser records no movies; use plica.movie in Python");
  const pictures = [...holder.querySelectorAll<HTMLCanvasElement>("canvas.picture")].filter((canvas) =>
    canvas.clientWidth > 0);
  const canvas = document.createElement("canvas");
  canvas.width = 2 * Math.ceil(pictures.reduce((sum, one) => sum + one.width, 0) / 2); // even, as codecs want it
  canvas.height = 2 * Math.ceil(pictures[0].height / 2);
  const context = canvas.getContext("2d")!;
  const recorder = new MediaRecorder(canvas.captureStream(perSecond),
    { mimeType: kind[0], videoBitsPerSecond: 8_000_000 });
  const parts: Blob[] = [];
  recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
  const ended = new Promise((resolve) => recorder.addEventListener("stop", resolve));
  recorder.start(250);
  const paper = getComputedStyle(document.body).backgroundColor;
  while (goesOn()) {
    await new Promise((resolve) => requestAnimationFrame(resolve));
    context.fillStyle = paper;
    context.fillRect(0, 0, canvas.width, canvas.height);
    let x = 0;
    for (const picture of pictures) {
      context.drawImage(picture, x, 0);
      x += picture.width;
    }
  }
  await new Promise((resolve) => setTimeout(resolve, 400)); // the last frame
  recorder.stop();
  await ended;
  return { name: `plica.${kind[1]}`, content: new Blob(parts, { type: kind[0] }) };
}
