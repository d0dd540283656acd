/* Round bores: how many cords fit side by side through one, and how wide one has to be for so many to be drawn with ease. */
#ifndef THR_BORE_H
#define THR_BORE_H

enum { THR_BORE_MOST = 1000 }; /* cords that are counted */

/* Cords of diameter cord that fit through a bore (the same unit): never more than truly do, as the packings below are real ones;
 * 0 if none does. From 40 cord diameters on THR_BORE_MOST. Up to 20 cords the best packings known (R. L. Graham, B. D.
 * Lubachevsky, K. J. Nurmela, P. R. J. Ostergard, "Dense packings of congruent circles in a circle", Discrete Math. 181, 1998),
 * beyond them the fullest of three places of a hexagonal grid. O(n). */
int thr_bore_fits(double bore, double cord);

/* Bore where none is given, in cord diameters: wide enough for one cord. */
static const double THR_BORE_CORDS = 2;

/* Bore through which n >= 1 cords are drawn with ease, in cord diameters: sqrt(n / fill), where the cords' sections fill no more
 * of the bore's than is allowed in a conduit through which cables are pulled: 0.53 for one, 0.31 for two, 0.40 for more (NFPA 70,
 * National Electrical Code, chapter 9, table 1). So 1.37, 2.54, 2.74, 3.16: always wider than the narrowest that holds them. */
double thr_bore_clear(int n);

#endif
