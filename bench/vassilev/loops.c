/* One thread goes through springs and adds to both ends; several find the pull of each spring and
 * let every vertex gather its own, to the same bits. One thread corrects velocities spring after
 * spring, several colour after colour. */
#include "bench/vassilev/loops.h"

#include "bench/serve.h"

#include <math.h>
#include <sched.h>
#include <stdio.h>
#include <stdlib.h>

/* Cores are free while this is measured: who waits turns, and gives way only after a long time. */
void loops_wait(struct loops_team *team)
{
    enum { TURNS = 20000 };
    const unsigned round = atomic_load(&team->round);
    if (atomic_fetch_add(&team->arrived, 1) + 1 == team->threads) {
        atomic_store(&team->arrived, 0);
        atomic_fetch_add(&team->round, 1);
        return;
    }
    for (unsigned turn = 0; atomic_load(&team->round) == round; turn++)
        if (turn > TURNS)
            sched_yield();
}

struct range {
    uint32_t from, to;
};

static struct range part(uint32_t n, unsigned threads, unsigned thread)
{
    return (struct range){(uint32_t)((uint64_t)n * thread / threads),
                          (uint32_t)((uint64_t)n * (thread + 1) / threads)};
}

/* ---- 1: springs ---- */

/* On end 0 of a spring from a to b. */
PHYS_INLINE void pull(const struct loops_spring *spring, const phys_vec *a, const phys_vec *b,
                      const phys_vec *va, const phys_vec *vb, phys_vec *force)
{
    const phys_vec d = *b - *a, dv = *vb - *va;
    const double length = sqrt(phys_dot(&d, &d));
    const phys_vec u = d * (length > 0 ? 1 / length : 0);
    *force =
        (spring->stiffness * (length - spring->length) + spring->damping * phys_dot(&u, &dv)) * u;
}

static void springs_scatter(struct loops *l)
{
    for (uint32_t i = 0; i < l->n; i++)
        l->f[i] = (phys_vec){0};
    for (uint32_t i = 0; i < l->n_springs; i++) {
        const uint32_t a = l->spring[i].end[0], b = l->spring[i].end[1];
        phys_vec force;
        pull(l->spring + i, l->x + a, l->x + b, l->v + a, l->v + b, &force);
        l->f[a] += force;
        l->f[b] -= force;
    }
}

static void springs_pull(struct loops *l, struct range on)
{
    for (uint32_t i = on.from; i < on.to; i++) {
        const uint32_t a = l->spring[i].end[0], b = l->spring[i].end[1];
        pull(l->spring + i, l->x + a, l->x + b, l->v + a, l->v + b, l->pull + i);
    }
}

static void springs_gather(struct loops *l, struct range on)
{
    for (uint32_t i = on.from; i < on.to; i++) {
        phys_vec sum = {0};
        for (uint32_t k = l->first[i]; k < l->first[i + 1]; k++) {
            const phys_vec *one = l->pull + l->at[k] / 2;
            sum += l->at[k] % 2 ? -*one : *one;
        }
        l->f[i] = sum;
    }
}

static void springs(struct loops_team *team, unsigned thread)
{
    struct loops *l = team->loops;
    if (team->threads == 1) {
        springs_scatter(l);
        return;
    }
    springs_pull(l, part(l->n_springs, team->threads, thread));
    loops_wait(team);
    springs_gather(l, part(l->n, team->threads, thread));
}

/* ---- 2: external forces; 3: joints; 4: velocities and collisions ---- */

static void outside(struct loops *l, struct range on)
{
    for (uint32_t i = on.from; i < on.to; i++)
        l->f[i] += l->load[i] - l->drag[i] * l->v[i];
}

static void joints(struct loops *l)
{
    for (uint32_t i = 0; i < l->n_joints; i++) {
        const struct loops_joint *joint = l->joint + i;
        const uint32_t a = joint->vertex, b = joint->end[0], c = joint->end[1];
        const double t = joint->share, s = 1 - t;
        const struct loops_spring spring = {
            {a, b}, joint->stiffness, joint->damping, joint->length};
        const phys_vec place = s * l->x[b] + t * l->x[c], speed = s * l->v[b] + t * l->v[c];
        phys_vec force;
        pull(&spring, l->x + a, &place, l->v + a, &speed, &force);
        l->f[a] += force;
        l->f[b] -= s * force;
        l->f[c] -= t * force;
    }
}

/* A vertex between front and back goes to the nearer of the two, and loses the velocity into it. */
static uint64_t collide(struct loops *l, struct range on)
{
    enum { AT_ONCE = 32 };
    struct contact_hit hit[AT_ONCE];
    uint64_t inside = 0;
    for (uint32_t from = on.from; from < on.to; from += AT_ONCE) {
        const uint32_t some = on.to - from < AT_ONCE ? on.to - from : AT_ONCE;
        contact_image_closest(&l->image, some, l->x + from, hit);
        for (uint32_t k = 0; k < some; k++) {
            const uint32_t i = from + k;
            if (!(hit[k].gap < 0) || l->free[i] < 1)
                continue;
            const double in = phys_dot(&hit[k].normal, l->v + i);
            l->v[i] -= (in < 0 ? in : 0) * hit[k].normal;
            l->x[i] -= hit[k].gap * hit[k].normal;
            inside++;
        }
    }
    return inside;
}

static uint64_t velocities(struct loops *l, struct range on)
{
    for (uint32_t i = on.from; i < on.to; i++)
        l->v[i] += l->h * (l->free[i] * (l->f[i] / l->mass[i]));
    return l->maps ? collide(l, on) : 0;
}

/* ---- 5: velocities of springs that are too long; 6: positions ---- */

/* Both ends of a spring that is too long and grows get the mean velocity along it, by mass; what a
 * pin holds keeps its own. */
PHYS_INLINE void correct(struct loops *l, const struct loops_spring *spring)
{
    const uint32_t a = spring->end[0], b = spring->end[1];
    const phys_vec d = l->x[b] - l->x[a], dv = l->v[b] - l->v[a];
    const double square = phys_dot(&d, &d), most = l->limit * spring->length;
    const double grows = phys_dot(&d, &dv);
    if (!(square > most * most && grows > 0))
        return;
    const double wa = l->free[a] / l->mass[a], wb = l->free[b] / l->mass[b];
    if (!(wa + wb > 0))
        return;
    const phys_vec change = grows / square / (wa + wb) * d;
    l->v[a] += wa * change;
    l->v[b] -= wb * change;
}

static void corrections(struct loops_team *team, unsigned thread)
{
    struct loops *l = team->loops;
    for (uint32_t i = 0; team->threads == 1 && l->limit > 0 && i < l->n_springs; i++)
        correct(l, l->spring + i);
    for (uint32_t c = 0; team->threads > 1 && l->limit > 0 && c < l->n_colours; c++) {
        const uint32_t first = l->colour_first[c];
        const struct range on = part(l->colour_first[c + 1] - first, team->threads, thread);
        for (uint32_t i = on.from; i < on.to; i++)
            correct(l, l->spring + l->by_colour[first + i]);
        loops_wait(team);
    }
}

static void positions(struct loops *l, struct range on)
{
    for (uint32_t i = on.from; i < on.to; i++)
        l->x[i] += l->h * l->v[i];
}

/* ---- Steps ---- */

/* Ends loop k: the first thread notes how long it took all of them. */
static void end_loop(struct loops_team *team, unsigned thread, int k, double *begin)
{
    loops_wait(team);
    if (thread)
        return;
    const double now = serve_seconds();
    team->seconds[k] += now - *begin;
    *begin = now;
}

static void step(struct loops_team *team, unsigned thread)
{
    struct loops *l = team->loops;
    const struct range on = part(l->n, team->threads, thread);
    double begin = serve_seconds();
    springs(team, thread);
    end_loop(team, thread, 0, &begin);
    outside(l, on);
    end_loop(team, thread, 1, &begin);
    if (!thread)
        joints(l);
    if (l->self) {
        loops_wait(team);
        loops_repel(team, thread, on.from, on.to);
    }
    end_loop(team, thread, 2, &begin);
    const uint64_t inside = velocities(l, on);
    atomic_fetch_add(&team->all_inside, inside);
    end_loop(team, thread, 3, &begin);
    corrections(team, thread);
    end_loop(team, thread, 4, &begin);
    positions(l, on);
    end_loop(team, thread, 5, &begin);
}

struct member {
    struct loops_team *team;
    unsigned thread;
};

static void *work(void *context)
{
    const struct member *member = context;
    for (uint64_t i = 0; i < member->team->steps && !atomic_load(&member->team->failed); i++) {
        loops_wait(member->team);
        step(member->team, member->thread);
    }
    return NULL;
}

static int fail(const char *what)
{
    fprintf(stderr, "vassilev: %s\n", what);
    return 1;
}

static void free_team(struct loops_team *team)
{
    for (unsigned t = 0; t < team->threads; t++) {
        free(team->found[t].push);
        team->found[t] = (struct loops_pushes){0};
    }
    free(team->pair);
    team->pair = NULL;
    team->room = team->n_pairs = 0;
    pthread_mutex_destroy(&team->lock);
}

int loops_run(struct loops_team *team)
{
    pthread_t thread[LOOPS_MOST_THREADS];
    struct member member[LOOPS_MOST_THREADS];
    if (!team->threads || team->threads > LOOPS_MOST_THREADS)
        return fail("1 to 64 threads");
    if (pthread_mutex_init(&team->lock, NULL))
        return fail("no lock");
    for (unsigned t = 0; t < team->threads; t++)
        member[t] = (struct member){team, t};
    for (unsigned t = 1; t < team->threads; t++)
        if (pthread_create(thread + t, NULL, work, member + t)) {
            fail("no thread");
            exit(1); /* others wait for it */
        }
    work(member);
    for (unsigned t = 1; t < team->threads; t++)
        pthread_join(thread[t], NULL);
    team->inside = atomic_load(&team->all_inside);
    for (unsigned t = 0; t < team->threads; t++)
        team->pushes += team->found[t].all;
    const bool failed = atomic_load(&team->failed);
    free_team(team);
    return failed ? fail("no memory") : 0;
}
