#ifndef CLOTH_CONTACT_PAIR_H
#define CLOTH_CONTACT_PAIR_H

#include "cloth/physics/vec.h"

/* Pairs of features that may touch. Each has four corners, x[4] in m. Pure functions of + - * / and
 * sqrt; nothing is allocated. */

enum contact_pair {
    CONTACT_VT, /* corner 0 against the triangle 1 2 3 */
    CONTACT_EE  /* the edge 0 1 against the edge 2 3 */
};

/* The closest points of the two features. */
struct contact_nearest {
    double weight[4]; /* of the first feature >= 0 with sum 1, of the second <= 0 with sum -1 */
    phys_vec normal;  /* of length 1, from the second feature to the first */
    double gap;       /* m, >= 0; sum weight x = normal gap */
};

/* Features may be degenerate or parallel: of closest points that are as near, one is taken. If the
 * gap is 0, or only rounding, the normal is a direction across both. Errors: coordinates that are
 * not finite give a gap that is not. */
void contact_nearest_of(enum contact_pair pair, const phys_vec x[4], struct contact_nearest *to);

#endif
