/* Certificates of random pairs, some at a time, so that they lie in the first cache as corners do
 * that a task has just gathered. */
#include "bench/contact/contact.h"
#include "bench/contact/shapes.h"

#include "cloth/base/simd.h"
#include "cloth/contact/certificate.h"

#include <math.h>

enum { BATCH = 64 };
static const double SIDE = 0.01, WAY = 0.002, THICKNESS = 0.001; /* m */

static void draw_vector(uint64_t *seed, double reach, phys_vec *x)
{
    for (int c = 0; c < 3; c++)
        (*x)[c] = contact_draw(seed, reach);
    (*x)[3] = 0;
}

static void draw_pair(uint64_t *seed, struct contact_moving *pair)
{
    phys_vec common, own;
    pair->pair = contact_draw(seed, 1) < 0 ? CONTACT_VT : CONTACT_EE;
    draw_vector(seed, WAY, &common);
    for (int k = 0; k < 4; k++) {
        draw_vector(seed, SIDE / 2, pair->x + k);
        draw_vector(seed, WAY, &own);
        pair->y[k] = pair->x[k] + common + own;
    }
}

static void draw_batch(uint64_t *seed, struct contact_moving pair[BATCH])
{
    for (int i = 0; i < BATCH; i++)
        draw_pair(seed, pair + i);
}

static size_t certify(const struct contact_moving pair[BATCH])
{
    enum contact_passing passing[BATCH];
    size_t n = 0;
    contact_pass_all(BATCH, pair, THICKNESS, INFINITY, passing);
    for (int i = 0; i < BATCH; i++)
        n += passing[i] != CONTACT_MAY_TOUCH;
    return n;
}

static int check_cut(const struct contact_moving *pair)
{
    double t[4] = {1, 1, 1, 1};
    phys_vec end[4];
    if (!contact_cut(pair->pair, pair->x, pair->y, THICKNESS, 0, t))
        return contact_certify(pair->pair, pair->x, pair->x, THICKNESS)
                   ? serve_fail("wrong answer: a pair that holds at the start is not cut")
                   : 0;
    for (int k = 0; k < 4; k++)
        end[k] = pair->x[k] + t[k] * (pair->y[k] - pair->x[k]);
    return contact_certify(pair->pair, pair->x, end, THICKNESS)
               ? 0
               : serve_fail("wrong answer: a pair that is cut does not pass");
}

/* The same pairs again: as many must pass without wide instructions, and the others once cut. */
static int check(uint64_t pairs, size_t n_certain)
{
    const enum cloth_simd wide = cloth_simd;
    struct contact_moving pair[BATCH];
    uint64_t seed = 1;
    size_t n = 0;
    int code = 0;
    cloth_simd = CLOTH_SIMD_NONE;
    for (uint64_t done = 0; done < pairs && !code; done += BATCH) {
        draw_batch(&seed, pair);
        for (int i = 0; i < BATCH && !code; i++)
            if (contact_certify(pair[i].pair, pair[i].x, pair[i].y, THICKNESS))
                n++;
            else
                code = check_cut(pair + i);
    }
    cloth_simd = wide;
    if (!code && n != n_certain)
        code = serve_fail("wrong answer: not those of kernels without wide instructions");
    return code;
}

/* Seconds a pair and the share that passes, of at least as many pairs as are asked for. */
static int run(struct serve_request *request, double *seconds, double *share)
{
    const uint64_t pairs = serve_number(request, "pairs");
    struct contact_moving pair[BATCH];
    uint64_t seed = 1, done = 0;
    size_t n = 0;
    *seconds = 0;
    for (; done < pairs; done += BATCH) {
        draw_batch(&seed, pair);
        const double begin = serve_seconds();
        n += certify(pair);
        *seconds += serve_seconds() - begin;
    }
    *share = (double)n / (double)done;
    *seconds /= (double)done;
    return check(pairs, n);
}

static int certify_time(void *context, struct serve_request *request, double *value)
{
    double share;
    (void)context;
    return run(request, value, &share);
}

static int certify_share(void *context, struct serve_request *request, double *value)
{
    double seconds;
    (void)context;
    return run(request, &seconds, value);
}

const struct serve_run contact_certify_runs[] = {
    {"certify", certify_time}, {"uncut", certify_share}, {0}};
