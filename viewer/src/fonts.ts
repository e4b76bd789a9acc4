// Of what is drawn on a canvas.
export const plotFont = "12px system-ui, sans-serif";
