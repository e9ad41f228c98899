/** The table of a DVD's grating in aluminium, for loadGrating(). */
export const dvd: URL;
