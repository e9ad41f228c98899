// The address of the table of a compact disc's grating in aluminium, for loadGrating(). By itself, as bundlers take along 4.2 MB with this line.
export const cd = new URL('../gratings/cd.bin', import.meta.url);
