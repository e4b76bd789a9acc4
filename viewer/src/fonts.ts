// Fonts of canvases.
export const plotFont = "12px system-ui, sans-serif";
