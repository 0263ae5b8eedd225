#ifndef CLOTH_CONTACT_PUSH_H
#define CLOTH_CONTACT_PUSH_H

#include "cloth/contact/certificate.h"

#include <math.h>

/* Pushes that part two features where a step ends, along a normal out of the second one. Pure; m.
 */

/* Parts of the gap at the step's begin, of the thickness, and of the margin: pushed features end
 * the step as far apart as the less of the first two, but at least the third. Certificates ask for
 * half of the first, or a tenth of the second, and the margin (certificate.h). The features still
 * come nearer, so pushes take energy away. */
#define CONTACT_PUSH_OF_GAP       0.75
#define CONTACT_PUSH_OF_THICKNESS 0.12
#define CONTACT_PUSH_OF_MARGIN    1.2

static inline double contact_push_gap(double gap, double thickness)
{
    const double less = fmin(CONTACT_PUSH_OF_GAP * gap, CONTACT_PUSH_OF_THICKNESS * thickness);
    return fmax(less, CONTACT_PUSH_OF_MARGIN * CONTACT_MARGIN);
}

/* Corners 0 .. first - 1 are of the first feature, the others, to n - 1, of the second. */
struct contact_pushed {
    unsigned n, first, held; /* held: bit k: corner k cannot be pushed */
    double gap, along[4];    /* wanted; places along the normal */
};

/* The way that takes a corner out of the gap around `middle`, where it is not held. */
static inline double contact_push_of(const struct contact_pushed *p, unsigned k, double middle)
{
    if (p->held >> k & 1)
        return 0;
    return k < p->first ? fmax(middle + p->gap / 2 - p->along[k], 0)
                        : fmin(middle - p->gap / 2 - p->along[k], 0);
}

/* Finds the push of each corner: the middle of the gap is where they sum to zero, so equal masses
 * keep their momentum. Held corners bound it. Returns false if those of both features do: no push
 * parts them. */
static inline bool contact_push_apart(const struct contact_pushed *p, double push[4])
{
    enum { HALVINGS = 50 }; /* of an interval: as fine as its numbers */
    double low = -INFINITY, high = INFINITY, least = INFINITY, most = -INFINITY;
    for (unsigned k = 0; k < p->n; k++) {
        least = fmin(least, p->along[k] - p->gap);
        most = fmax(most, p->along[k] + p->gap);
        if (p->held >> k & 1 && k < p->first)
            high = fmin(high, p->along[k] - p->gap / 2);
        else if (p->held >> k & 1)
            low = fmax(low, p->along[k] + p->gap / 2);
    }
    if (!(low <= high))
        return false;
    low = fmax(low, least);
    high = fmin(high, most);
    for (int i = 0; i < HALVINGS; i++) {
        const double middle = 0.5 * (low + high);
        double sum = 0;
        for (unsigned k = 0; k < p->n; k++)
            sum += contact_push_of(p, k, middle);
        *(sum > 0 ? &high : &low) = middle;
    }
    for (unsigned k = 0; k < p->n; k++)
        push[k] = contact_push_of(p, k, 0.5 * (low + high));
    return true;
}

#endif
