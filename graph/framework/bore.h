/* How many cords fit side by side through a round bore, and how wide a bore a number of them needs: equal circles in a circle. */
#ifndef THR_BORE_H
#define THR_BORE_H

enum { THR_BORE_MOST = 1000 }; /* cords that are counted */

/* Cords of diameter cord that fit through a bore (the same unit): never more than truly do, as the packings below are real ones;
 * 0 if none does. From 40 cord diameters on THR_BORE_MOST. Up to 20 cords the best packings known (R. L. Graham, B. D.
 * Lubachevsky, K. J. Nurmela, P. R. J. Ostergard, "Dense packings of congruent circles in a circle", Discrete Math. 181, 1998),
 * beyond them the fullest of three places of a hexagonal grid. O(n). */
int thr_bore_fits(double bore, double cord);

/* Diameter of the narrowest bore of these packings for n >= 1 cords, in cord diameters; beyond THR_BORE_MOST of full hexagonal
 * rings. O(n) times 40. */
double thr_bore_for(int n);

#endif
