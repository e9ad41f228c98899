// The address of the table of a DVD's grating in aluminium, for loadGrating(). By itself, as bundlers take along 4.2 MB with this line.
export const dvd = new URL('../gratings/dvd.bin', import.meta.url);
