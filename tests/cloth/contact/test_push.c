/* Pushes part features that a step drives into each other: the certificate passes them, held
 * corners stay, free ones keep their momentum. */
#include "cloth/contact/certificate.h"
#include "cloth/contact/push.h"
#include "tests/cloth/contact/pairs.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdio.h>

/* Pushes the corners of a pair. Returns false if nothing parts them. */
static bool push(enum contact_pair pair, const phys_vec x[4], unsigned held, phys_vec y[4],
                 double pushed[4])
{
    struct contact_nearest nearest;
    contact_nearest_of(pair, x, &nearest);
    struct contact_pushed p = {.n = 4,
                               .first = pair == CONTACT_VT ? 1 : 2,
                               .held = held,
                               .gap = contact_push_gap(nearest.gap, THICKNESS)};
    for (int k = 0; k < 4; k++) {
        const phys_vec from = y[k] - y[0];
        p.along[k] = phys_dot(&nearest.normal, &from);
    }
    if (!contact_push_apart(&p, pushed))
        return false;
    for (int k = 0; k < 4; k++)
        y[k] += pushed[k] * nearest.normal;
    return true;
}

UNIT_LOOP(parts, 0, 2)
{
    const struct pairs_sort *sort = PAIRS_SORTS + _i;
    int n = pairs_count(), n_pushed = 0, n_refused = 0;
    for (int i = 0; i < n; i++) {
        const enum contact_pair pair = KINDS[i & 1];
        const unsigned held = i % 3 ? 0 : (unsigned)uniform(0, 16);
        double pushed[4], sum = 0;
        phys_vec x[4], y[4];
        pairs_draw(pair, sort, x, y);
        if (contact_certify(pair, x, y, THICKNESS) || !contact_certify(pair, x, x, THICKNESS))
            continue;
        if (!push(pair, x, held, y, pushed)) {
            PAIRS_CHECK(held);
            n_refused++;
            continue;
        }
        for (int k = 0; k < 4; k++) {
            PAIRS_CHECK(pushed[k] == 0 || !(held >> k & 1));
            sum += pushed[k];
        }
        PAIRS_CHECK(held || fabs(sum) < 1e-12);
        PAIRS_CHECK(contact_certify(pair, x, y, THICKNESS));
        n_pushed++;
    }
    printf("# %s: %d of %d pushed, %d held in each other's way\n", sort->name, n_pushed, n,
           n_refused);
    ck_assert(n_pushed > 0 && n_refused > 0);
}
