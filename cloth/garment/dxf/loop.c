/* A piece's loop. Programs draw it as one polyline with turn points, or as a polyline for each
 * edge. Half pieces lie at a mirror line, and their sew lines may end there. */
#include "cloth/base/vector.h"
#include "cloth/garment/dxf/dxf.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const double NEAR = 1e-4;        /* m: ends of lines that meet; files round to 0.01 mm */
static const double SAME = 1e-5;        /* m: places that are one */
static const double REACH = 0.03;       /* m: from a notch at the boundary to a sew line inside */
static const double BESIDE = 1e-3;      /* m: notches so near to a corner are at it */
static const double SHARP = 0.86602540; /* cos 30 degrees: a corner turns by more */

struct making {
    const struct dxf *dxf;
    const struct dxf_piece *piece;
    double near, same; /* in the file's unit */
    unsigned char *used;
    struct cloth_error *error;
};

static double distance(const double a[2], const double b[2])
{
    return sqrt(cloth_square_2(a, b));
}

static struct dxf_stop *stop_at(const struct dxf_loop *loop, size_t i)
{
    return (struct dxf_stop *)loop->stop.items + i % loop->stop.n;
}

static const double *place_of(const struct making *making, const struct dxf_line *line, uint32_t i)
{
    return (const double *)making->piece->place.items + 2 * ((size_t)line->first + i);
}

/* ---- Lines that are joined end to end ---- */

static void put_stop(const struct making *making, struct dxf_loop *loop, const double x[2])
{
    const struct dxf_stop stop = {.x = {x[0], x[1]}};
    if (!loop->stop.n || distance(stop_at(loop, loop->stop.n - 1)->x, x) > making->same)
        cloth_list_put(&loop->stop, &stop, sizeof stop, making->error);
}

static void put_line(const struct making *making, struct dxf_loop *loop,
                     const struct dxf_line *line, bool back)
{
    for (uint32_t i = 0; i < line->n; i++)
        put_stop(making, loop, place_of(making, line, back ? line->n - 1 - i : i));
}

static void turn_round(struct dxf_loop *loop)
{
    for (size_t i = 0, k = loop->stop.n; i + 1 < k; i++, k--) {
        const struct dxf_stop kept = *stop_at(loop, i);
        *stop_at(loop, i) = *stop_at(loop, k - 1);
        *stop_at(loop, k - 1) = kept;
    }
}

/* The place where the loop ended becomes a corner. True: a line goes on from there. */
static bool go_on(const struct making *making, struct dxf_loop *loop, enum dxf_layer layer)
{
    const struct dxf_line *line = making->piece->line.items;
    struct dxf_stop *last = stop_at(loop, loop->stop.n - 1);
    for (size_t i = 0; i < making->piece->line.n; i++) {
        if (making->used[i] || line[i].layer != layer || line[i].closed || line[i].n < 2)
            continue;
        const bool from = distance(place_of(making, line + i, 0), last->x) <= making->near;
        if (!from && distance(place_of(making, line + i, line[i].n - 1), last->x) > making->near)
            continue;
        making->used[i] = 1;
        last->corner = true;
        put_line(making, loop, line + i, !from);
        return !making->error->code;
    }
    return false;
}

/* True if it ends where it begins: its last place is dropped then. */
static bool close_loop(const struct making *making, struct dxf_loop *loop, bool joined)
{
    if (loop->stop.n < 3 ||
        distance(stop_at(loop, 0)->x, stop_at(loop, loop->stop.n - 1)->x) > making->near)
        return false;
    loop->stop.n--;
    stop_at(loop, 0)->corner |= joined;
    return true;
}

/* The chain that a line is part of. */
static void make_chain(const struct making *making, struct dxf_loop *loop,
                       const struct dxf_line *line)
{
    bool joined = false;
    loop->stop.n = 0;
    loop->unfolded = false;
    put_line(making, loop, line, false);
    loop->closed = line->closed;
    if (loop->closed)
        close_loop(making, loop, false);
    for (int k = 0; k < 2 && !loop->closed && loop->stop.n; k++) {
        while (!(loop->closed = close_loop(making, loop, joined)) &&
               go_on(making, loop, line->layer))
            joined = true;
        if (!loop->closed)
            turn_round(loop);
    }
}

/* Notches that are drawn as slits, to a place and back, go: a slit has no room between its sides.
 */
static void drop_slits(const struct making *making, struct dxf_loop *loop)
{
    struct dxf_stop *stop = loop->stop.items;
    size_t n = 0;
    for (size_t i = 0; i < loop->stop.n; i++) {
        stop[n++] = stop[i];
        while (n >= 3 && distance(stop[n - 3].x, stop[n - 1].x) <= making->near) {
            n -= 2;
            stop[n - 1].notch = true;
        }
    }
    loop->stop.n = n;
}

/* ---- Corners ---- */

static void mark_turn_points(const struct making *making, struct dxf_loop *loop)
{
    const double(*turn)[2] = (const double(*)[2])making->piece->turn.items;
    for (size_t i = 0; i < loop->stop.n; i++)
        for (size_t k = 0; k < making->piece->turn.n && !stop_at(loop, i)->corner; k++)
            stop_at(loop, i)->corner = distance(stop_at(loop, i)->x, turn[k]) <= making->near;
}

static bool is_sharp(const double a[2], const double b[2], const double c[2])
{
    double sine, cosine;
    const double squares = cloth_angle(a, b, c, &sine, &cosine);
    return cosine > -SHARP * sqrt(squares);
}

static size_t count_corners(const struct dxf_loop *loop)
{
    size_t n = 0;
    for (size_t i = 0; i < loop->stop.n; i++)
        n += stop_at(loop, i)->corner;
    return n;
}

/* A loop that says nothing of its corners has them where it turns; a smooth one is cut in two. */
static void find_corners(struct dxf_loop *loop)
{
    const size_t n = loop->stop.n;
    size_t far = 0, from = 0;
    if (count_corners(loop) >= 2)
        return;
    for (size_t i = 0; i < n; i++)
        stop_at(loop, i)->corner |=
            is_sharp(stop_at(loop, i + n - 1)->x, stop_at(loop, i)->x, stop_at(loop, i + 1)->x);
    if (count_corners(loop) >= 2)
        return;
    while (from + 1 < n && !stop_at(loop, from)->corner)
        from++;
    from = stop_at(loop, from)->corner ? from : 0;
    for (size_t i = 0; i < n; i++)
        if (distance(stop_at(loop, from)->x, stop_at(loop, i)->x) >
            distance(stop_at(loop, from)->x, stop_at(loop, far)->x))
            far = i;
    stop_at(loop, from)->corner = stop_at(loop, far)->corner = true;
}

/* ---- Half pieces ---- */

struct mirror {
    double from[2], along[2]; /* along: of length 1 */
};

static bool take_mirror(const struct making *making, struct mirror *mirror)
{
    const struct dxf_line *line = dxf_line_of(making->piece, DXF_MIRROR);
    if (!line)
        return false;
    const double *a = place_of(making, line, 0), *b = place_of(making, line, line->n - 1);
    const double length = distance(a, b);
    *mirror = (struct mirror){{a[0], a[1]}, {(b[0] - a[0]) / length, (b[1] - a[1]) / length}};
    return length > making->near;
}

/* How far to the left of it a place is. */
static double beside(const struct mirror *mirror, const double x[2])
{
    return mirror->along[0] * (x[1] - mirror->from[1]) -
           mirror->along[1] * (x[0] - mirror->from[0]);
}

static void reflect(const struct mirror *mirror, double x[2])
{
    const double off = 2 * beside(mirror, x);
    x[0] += off * mirror->along[1];
    x[1] -= off * mirror->along[0];
}

static bool is_on(const struct making *making, const struct mirror *mirror,
                  const struct dxf_loop *loop, size_t i)
{
    return fabs(beside(mirror, stop_at(loop, i)->x)) <= making->near;
}

/* Turns the list so that it begins where the loop leaves the mirror line and ends where it comes
 * back; places between are dropped. False: no edge of it lies there, or several do. */
static bool begin_at_mirror(const struct making *making, const struct mirror *mirror,
                            struct dxf_loop *loop)
{
    const size_t n = loop->stop.n;
    size_t first = 0, n_off = 0, runs = 0;
    for (size_t i = 0; i < n; i++) {
        const bool on = is_on(making, mirror, loop, i);
        n_off += !on;
        if (on && !is_on(making, mirror, loop, i + 1)) {
            first = i;
            runs++;
        }
    }
    if (runs != 1 || n_off + 2 > n || !n_off)
        return false;
    struct dxf_stop *turned = cloth_alloc(n_off + 2, sizeof *turned, making->error);
    if (!turned)
        return false;
    for (size_t i = 0; i < n_off + 2; i++)
        turned[i] = *stop_at(loop, first + i);
    memcpy(loop->stop.items, turned, (n_off + 2) * sizeof *turned);
    loop->stop.n = n_off + 2;
    free(turned);
    return true;
}

/* Adds the other half. Where both meet there is a corner only if the loop turns there. */
static void unfold(const struct making *making, struct dxf_loop *loop)
{
    struct mirror mirror;
    const size_t n = loop->stop.n;
    if (!take_mirror(making, &mirror) || n < 3)
        return;
    if (loop->closed ? !begin_at_mirror(making, &mirror, loop)
                     : !is_on(making, &mirror, loop, 0) || !is_on(making, &mirror, loop, n - 1))
        return;
    const size_t half = loop->stop.n;
    for (size_t i = half - 1; i-- > 1 && !making->error->code;) {
        struct dxf_stop stop = *stop_at(loop, i);
        reflect(&mirror, stop.x);
        cloth_list_put(&loop->stop, &stop, sizeof stop, making->error);
    }
    loop->closed = loop->unfolded = true;
    for (size_t k = 0; k < 2; k++) {
        const size_t i = k ? half - 1 : 0, all = loop->stop.n;
        stop_at(loop, i)->corner =
            is_sharp(stop_at(loop, i + all - 1)->x, stop_at(loop, i)->x, stop_at(loop, i + 1)->x);
    }
}

/* ---- Notches ---- */

/* Marks the place of the loop that is nearest to a notch, unless it is far from all of it. */
static void put_notch(const struct making *making, struct dxf_loop *loop, const double x[2])
{
    size_t at = 0;
    double least = INFINITY;
    for (size_t i = 0; i < loop->stop.n; i++) {
        const double square = cloth_segment_square(x, stop_at(loop, i)->x, stop_at(loop, i + 1)->x);
        at = square < least ? i : at;
        least = fmin(least, square);
    }
    if (sqrt(least) > REACH / making->dxf->unit)
        return;
    struct dxf_stop *end[2] = {stop_at(loop, at), stop_at(loop, at + 1)};
    struct dxf_stop notch = {.notch = true};
    const double part = cloth_segment_part(x, end[0]->x, end[1]->x);
    for (int c = 0; c < 2; c++)
        notch.x[c] = end[0]->x[c] + part * (end[1]->x[c] - end[0]->x[c]);
    for (int k = 0; k < 2; k++)
        if (distance(notch.x, end[k]->x) <=
            (end[k]->corner ? BESIDE / making->dxf->unit : making->same)) {
            end[k]->notch = true;
            return;
        }
    if (cloth_list_put(&loop->stop, &notch, sizeof notch, making->error))
        return;
    struct dxf_stop *stop = loop->stop.items;
    memmove(stop + at + 2, stop + at + 1, (loop->stop.n - at - 2) * sizeof *stop);
    stop[at + 1] = notch;
}

/* All notches, and of a half piece their images, become corners. */
static void mark_notches(const struct making *making, struct dxf_loop *loop)
{
    const double(*notch)[2] = (const double(*)[2])making->piece->notch.items;
    struct mirror mirror;
    const bool both = loop->unfolded && take_mirror(making, &mirror);
    for (size_t i = 0; i < making->piece->notch.n && !making->error->code; i++) {
        double image[2] = {notch[i][0], notch[i][1]};
        put_notch(making, loop, image);
        if (!both)
            continue;
        reflect(&mirror, image);
        put_notch(making, loop, image);
    }
    for (size_t i = 0; i < loop->stop.n; i++)
        stop_at(loop, i)->corner |= stop_at(loop, i)->notch;
}

/* ---- The loop ---- */

static double size_of(const struct dxf_loop *loop)
{
    double low[2] = {INFINITY, INFINITY}, high[2] = {-INFINITY, -INFINITY};
    for (size_t i = 0; i < loop->stop.n; i++)
        for (int c = 0; c < 2; c++) {
            low[c] = fmin(low[c], stop_at(loop, i)->x[c]);
            high[c] = fmax(high[c], stop_at(loop, i)->x[c]);
        }
    return loop->closed && loop->stop.n ? distance(low, high) : 0;
}

/* The largest loop of a layer; 0 of its places, if none closes: *open: a line of one that does
 * not. */
static void find_loop(const struct making *making, enum dxf_layer layer, struct dxf_loop *largest,
                      const struct dxf_line **open)
{
    const struct dxf_line *line = making->piece->line.items;
    struct dxf_loop loop = {0};
    for (size_t i = 0; i < making->piece->line.n && !making->error->code; i++) {
        if (making->used[i] || line[i].layer != layer || line[i].n < 2)
            continue;
        making->used[i] = 1;
        make_chain(making, &loop, line + i);
        if (count_corners(&loop) < 2)
            mark_turn_points(making, &loop);
        unfold(making, &loop);
        drop_slits(making, &loop);
        if (!loop.closed || loop.stop.n < 3)
            *open = line + i;
        else if (size_of(&loop) > size_of(largest)) {
            const struct dxf_loop kept = *largest;
            *largest = loop;
            loop = kept;
        }
    }
    free(loop.stop.items);
}

int dxf_loop_make(struct dxf_loop *loop, const struct dxf *dxf, const struct dxf_piece *piece,
                  bool notches, struct cloth_error *error)
{
    struct making making = {dxf, piece, NEAR / dxf->unit, SAME / dxf->unit, NULL, error};
    const struct dxf_line *open = NULL;
    *loop = (struct dxf_loop){0};
    making.used = cloth_alloc(piece->line.n, 1, error);
    if (making.used)
        find_loop(&making, DXF_SEW, loop, &open);
    if (making.used && !loop->stop.n)
        find_loop(&making, DXF_BOUNDARY, loop, &open);
    free(making.used);
    if (error->code)
        return error->code;
    if (!loop->stop.n)
        return dxf_fail(dxf, open ? open->at : piece->at, error,
                        "the boundary of piece '%.60s' is open: from here on its polylines of "
                        "layer 1 do not lead back to where they begin",
                        piece->name);
    find_corners(loop);
    if (notches)
        mark_notches(&making, loop);
    return error->code;
}
