// Pictures of the built-in scenarios, by name.
export const pictures: Record<string, string> = {};
