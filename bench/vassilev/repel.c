/* Cloth against cloth between pieces: boxes of two patches that come nearer than the thickness are
 * cut in four each, and the 16 pairs are met in turn. Each meeting is a task on a stack that all
 * threads share. Forces are noted, and added by who has the vertex: in an order that depends on
 * which thread found them, so that states of several threads agree to roundoff only. */
#include "bench/vassilev/loops.h"

#include <math.h>
#include <sched.h>
#include <stdlib.h>

/* ---- Patches ---- */

struct key {
    double along;
    uint32_t vertex;
};

static int compare_keys(const void *a, const void *b)
{
    const struct key *x = a, *y = b;
    if (x->along < y->along || y->along < x->along)
        return x->along < y->along ? -1 : 1;
    return (x->vertex > y->vertex) - (x->vertex < y->vertex);
}

static void box_of(const struct loops *l, uint32_t from, uint32_t to, double low[3], double high[3])
{
    for (int c = 0; c < 3; c++)
        low[c] = high[c] = l->x[l->order[from]][c];
    for (uint32_t i = from + 1; i < to; i++)
        for (int c = 0; c < 3; c++) {
            const double at = l->x[l->order[i]][c];
            low[c] = at < low[c] ? at : low[c];
            high[c] = at > high[c] ? at : high[c];
        }
}

/* Puts the vertices from .. to - 1 in the order along their longest axis. */
static int sort_along(struct loops *l, uint32_t from, uint32_t to)
{
    double low[3], high[3];
    int axis = 0;
    struct key *key = malloc((to - from) * sizeof *key);
    if (!key)
        return 1;
    box_of(l, from, to, low, high);
    for (int c = 1; c < 3; c++)
        axis = high[c] - low[c] > high[axis] - low[axis] ? c : axis;
    for (uint32_t i = from; i < to; i++)
        key[i - from] = (struct key){l->x[l->order[i]][axis], l->order[i]};
    qsort(key, to - from, sizeof *key, compare_keys);
    for (uint32_t i = from; i < to; i++)
        l->order[i] = key[i - from].vertex;
    free(key);
    return 0;
}

/* In two halves along the longest axis, and each of these so. */
static int cut_patch(struct loops *l, uint32_t number)
{
    struct loops_patch *patch = l->patch + number;
    const uint32_t from = patch->from, n = patch->to - from;
    if (n <= LOOPS_LEAF)
        return 0;
    int code = sort_along(l, from, patch->to);
    for (uint32_t half = 0; half < 2 && !code; half++)
        code = sort_along(l, from + n / 2 * half, half ? patch->to : from + n / 2);
    const uint32_t middle = from + n / 2, first = from + n / 4,
                   last = middle + (patch->to - middle) / 2;
    const uint32_t end[LOOPS_PARTS + 1] = {from, first, middle, last, patch->to};
    for (int k = 0; k < LOOPS_PARTS; k++) {
        patch->child[k] = l->n_patches++;
        l->patch[patch->child[k]] = (struct loops_patch){.from = end[k], .to = end[k + 1]};
    }
    return code;
}

int loops_cut(struct loops *l, const uint32_t *piece)
{
    int code = 0;
    /* Leaves have 4 vertices or are whole pieces, and of n leaves come n / 3 others. */
    l->patch = calloc(2 * (size_t)l->n + LOOPS_PARTS, sizeof *l->patch);
    for (uint32_t k = 0; l->patch && k < l->n_pieces; k++)
        l->patch[l->n_patches++] = (struct loops_patch){.from = piece[k], .to = piece[k + 1]};
    for (uint32_t i = 0; l->patch && i < l->n_patches && !code; i++)
        code = cut_patch(l, i);
    return !l->patch || code;
}

static void fit_leaves(struct loops *l, unsigned threads, unsigned thread)
{
    for (uint32_t i = thread; i < l->n_patches; i += threads) {
        struct loops_patch *patch = l->patch + i;
        if (!patch->child[0])
            box_of(l, patch->from, patch->to, patch->low, patch->high);
    }
}

static void fit_others(struct loops *l)
{
    for (uint32_t i = l->n_patches; i-- > 0;) {
        struct loops_patch *patch = l->patch + i;
        for (int k = 0; patch->child[0] && k < LOOPS_PARTS; k++) {
            const struct loops_patch *part = l->patch + patch->child[k];
            for (int c = 0; c < 3; c++) {
                patch->low[c] = k && patch->low[c] < part->low[c] ? patch->low[c] : part->low[c];
                patch->high[c] =
                    k && patch->high[c] > part->high[c] ? patch->high[c] : part->high[c];
            }
        }
    }
}

static bool overlap(const struct loops *l, uint32_t a, uint32_t b)
{
    const struct loops_patch *x = l->patch + a, *y = l->patch + b;
    for (int c = 0; c < 3; c++)
        if (x->low[c] > y->high[c] + l->thickness || y->low[c] > x->high[c] + l->thickness)
            return false;
    return true;
}

/* ---- Forces between vertices ---- */

static void note(struct loops_team *team, struct loops_pushes *found, const struct loops_push *push)
{
    if (found->n == found->room) {
        const size_t room = 2 * found->room + 256;
        struct loops_push *grown = realloc(found->push, room * sizeof *grown);
        if (!grown) {
            atomic_store(&team->failed, true);
            return;
        }
        found->push = grown;
        found->room = room;
    }
    found->push[found->n++] = *push;
}

/* Vertices of two leaves that are nearer than the thickness push each other apart by what is
 * missing; those of one seam do not. */
static void meet_leaves(struct loops_team *team, struct loops_pushes *found,
                        const struct loops_patch *a, const struct loops_patch *b)
{
    const struct loops *l = team->loops;
    const double most = l->thickness * l->thickness;
    for (uint32_t i = a->from; i < a->to; i++)
        for (uint32_t j = b->from; j < b->to; j++) {
            const uint32_t p = l->order[i], q = l->order[j];
            const phys_vec d = l->x[p] - l->x[q];
            const double square = phys_dot(&d, &d);
            if (!(square < most && square > 0) || l->seam[p] == l->seam[q])
                continue;
            const double distance = sqrt(square);
            const double force = l->stiffness * (l->thickness - distance) / distance;
            const struct loops_push push = {{p, q}, {force * d[0], force * d[1], force * d[2]}};
            note(team, found, &push);
        }
}

/* ---- Tasks ---- */

static void put_pair(struct loops_team *team, uint32_t a, uint32_t b)
{
    pthread_mutex_lock(&team->lock);
    if (team->n_pairs == team->room) {
        const size_t room = 2 * team->room + 256;
        uint32_t(*grown)[2] = realloc(team->pair, room * sizeof *grown);
        if (grown) {
            team->pair = grown;
            team->room = room;
        }
    }
    if (team->n_pairs < team->room) {
        atomic_fetch_add(&team->open, 1);
        team->pair[team->n_pairs][0] = a;
        team->pair[team->n_pairs++][1] = b;
    } else {
        atomic_store(&team->failed, true);
    }
    pthread_mutex_unlock(&team->lock);
}

static bool take_pair(struct loops_team *team, uint32_t pair[2])
{
    pthread_mutex_lock(&team->lock);
    const bool there = team->n_pairs > 0;
    if (there) {
        team->n_pairs--;
        pair[0] = team->pair[team->n_pairs][0];
        pair[1] = team->pair[team->n_pairs][1];
    }
    pthread_mutex_unlock(&team->lock);
    return there;
}

/* The parts of a patch that is cut, or itself. */
static uint32_t parts_of(const struct loops *l, uint32_t patch, uint32_t part[LOOPS_PARTS])
{
    part[0] = patch;
    if (!l->patch[patch].child[0])
        return 1;
    for (int k = 0; k < LOOPS_PARTS; k++)
        part[k] = l->patch[patch].child[k];
    return LOOPS_PARTS;
}

static void meet(struct loops_team *team, struct loops_pushes *found, const uint32_t pair[2])
{
    const struct loops *l = team->loops;
    uint32_t a[LOOPS_PARTS], b[LOOPS_PARTS];
    const uint32_t n_a = parts_of(l, pair[0], a), n_b = parts_of(l, pair[1], b);
    if (n_a == 1 && n_b == 1) {
        meet_leaves(team, found, l->patch + pair[0], l->patch + pair[1]);
        return;
    }
    for (uint32_t i = 0; i < n_a; i++)
        for (uint32_t j = 0; j < n_b; j++)
            if (overlap(l, a[i], b[j]))
                put_pair(team, a[i], b[j]);
}

static void work_off(struct loops_team *team, struct loops_pushes *found)
{
    uint32_t pair[2];
    while (atomic_load(&team->open) > 0)
        if (take_pair(team, pair)) {
            meet(team, found, pair);
            atomic_fetch_sub(&team->open, 1);
        } else {
            sched_yield();
        }
}

/* ---- All ---- */

static void add(struct loops *l, uint32_t from, uint32_t to, const struct loops_pushes *found)
{
    for (size_t i = 0; i < found->n; i++) {
        const struct loops_push *push = found->push + i;
        const phys_vec force = {push->force[0], push->force[1], push->force[2], 0};
        if (push->vertex[0] >= from && push->vertex[0] < to)
            l->f[push->vertex[0]] += force;
        if (push->vertex[1] >= from && push->vertex[1] < to)
            l->f[push->vertex[1]] -= force;
    }
}

void loops_repel(struct loops_team *team, unsigned thread, uint32_t from, uint32_t to)
{
    struct loops *l = team->loops;
    struct loops_pushes *found = team->found + thread;
    fit_leaves(l, team->threads, thread);
    found->n = 0;
    loops_wait(team);
    if (!thread) {
        fit_others(l);
        for (uint32_t a = 0; a < l->n_pieces; a++)
            for (uint32_t b = a + 1; b < l->n_pieces; b++)
                if (overlap(l, a, b))
                    put_pair(team, a, b);
    }
    loops_wait(team);
    work_off(team, found);
    found->all += found->n;
    loops_wait(team);
    for (unsigned t = 0; t < team->threads; t++)
        add(l, from, to, team->found + t);
}
