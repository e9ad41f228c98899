/** The table of a compact disc's grating in aluminium, for loadGrating(). */
export const cd: URL;
