/* Round bores: how many cords are drawn with ease through one, and how wide one has to be for so many. */
#ifndef THR_BORE_H
#define THR_BORE_H

/* Bore where none is given, in cord diameters: wide enough for one cord. */
static const double THR_BORE_CORDS = 2;

/* Bore through which n >= 1 cords are drawn with ease, in cord diameters: sqrt(n / fill), where the cords' sections fill no more
 * of the bore's than is allowed in a conduit through which cables are pulled: 0.53 for one, 0.31 for two, 0.40 for more (NFPA 70,
 * National Electrical Code, chapter 9, table 1). So 1.37, 2.54, 2.74, 3.16: always wider than the narrowest that holds them. */
double thr_bore_clear(int n);

enum { THR_BORE_MOST = 1000 }; /* cords that are counted */

/* Cords of diameter cord that are drawn with ease through a bore (the same unit); 0 if none is. O(n).
 * Example: through a bore of three cord diameters three cords, side by side it would hold seven. */
int thr_bore_fits(double bore, double cord);

#endif
