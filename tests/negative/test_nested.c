/* Tasks that fork: the whole table of rights, and what a body must not ask for. */

#include "tests/negative/misuse.h"
#include "tests/support/unit.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <string.h>

enum { MODES = 8 };

/* The requests of a body. */
enum deed {
    FORK, /* a child with its parameter in the mode `child` */
    FORK_FOREIGN,
    FORK_STALE,
    FORK_FREED,
    FORK_NONE,
    FORK_TWICE,
    FORK_OTHER_LAW,
    FORK_UNLISTED,
    FORK_UNLISTED_THEN_TWICE,
    FORK_AT,
    FORK_WITH_ARGUMENTS,
    FREE,
    FREE_TWICE,
    GET,
    GET_NOWHERE,
    GET_COUNT,
    OVERWRITE,
    SET_SIZED,
    RESIZE,
    CONTRIBUTE,
    CONTRIBUTE_BEYOND,
    NEW_NOWHERE,
    NEW_EMPTY,
    NEW_SIZED
};

struct args {
    enum deed deed;
    duite_mode child;
    int then; /* the body waits before it ends, or returns the code */
};

static duite *rt;
static duite_object object, foreign;
static duite_object stale; /* what an earlier body called its parameter */
static duite_kernel parents[MODES + 1], children[MODES + 1]; /* by mode; 0: no parameter */
static char names[2][MODES + 1][12];
static const char *const MODE[] = {"", "r", "w", "rw", "cw", "rp", "wp", "rwp", "cwp"};
static int told; /* what the call of a body returned, and what it said */
static char sentence[1024];

static int child(const duite_call *call)
{
    (void)call;
    return 0;
}

static const duite_kernel LEAST = {
    .name = "least", .body = child, .access = {DUITE_CW}, .law = DUITE_LAWS(&duite_min)};
static const duite_kernel LEAST_POSTPONED = {.name = "least, postponed",
                                             .body = child,
                                             .access = {DUITE_CWP},
                                             .law = DUITE_LAWS(&duite_min)};
static const duite_kernel TWO = {.name = "two", .body = child, .access = {DUITE_R, DUITE_RW}};

static int fork_made(const duite_call *call, const duite_kernel *kernel, enum deed deed)
{
    duite_object made;

    duite_new(call->rt, DUITE_I32, 1, &made);
    if (deed == FORK_FREED || deed == FREE_TWICE)
        duite_free(call->rt, made);
    if (deed == FREE_TWICE)
        return duite_free(call->rt, made);
    if (deed == FORK_TWICE)
        return DUITE_FORK(call->rt, kernel, NULL, made, made);
    return duite_fork(call->rt, kernel, NULL, 1, &made);
}

static int fork_something(const duite_call *call, const struct args *args)
{
    const duite_object none = DUITE_NO_OBJECT;
    const duite_kernel *kernel = &children[args->child];

    switch (args->deed) {
    case FORK_FOREIGN:
        return duite_fork(call->rt, kernel, NULL, 1, &foreign);
    case FORK_STALE:
        return duite_fork(call->rt, kernel, NULL, 1, &stale);
    case FORK_NONE:
        return duite_fork(call->rt, kernel, NULL, 1, &none);
    case FORK_FREED:
        return fork_made(call, kernel, args->deed);
    case FORK_TWICE:
        return fork_made(call, &TWO, args->deed);
    case FORK_OTHER_LAW:
        return duite_fork(call->rt, args->child == DUITE_CW ? &LEAST : &LEAST_POSTPONED, NULL, 1,
                          &call->param[0].object);
    case FORK_AT:
        return duite_fork_with(call->rt, &(duite_task_options){.at = &(int){0}}, kernel, NULL, 1,
                               &call->param[0].object);
    case FORK_WITH_ARGUMENTS:
        return duite_fork(call->rt, kernel, args, 1, &call->param[0].object);
    case FORK_UNLISTED:
        return duite_fork(call->rt, &UNLISTED, NULL, 1, &call->param[0].object);
    case FORK_UNLISTED_THEN_TWICE:
        duite_fork(call->rt, &UNLISTED, NULL, 1, &call->param[0].object);
        return fork_made(call, &TWO, FORK_TWICE);
    default:
        return duite_fork(call->rt, kernel, NULL, 1, &call->param[0].object);
    }
}

static int ask(const duite_call *call, const struct args *args)
{
    const duite_object own = call->n_params ? call->param[0].object : DUITE_NO_OBJECT;
    int32_t values[8] = {0};
    size_t count;
    duite_object made;

    switch (args->deed) {
    case FREE:
        return duite_free(call->rt, own);
    case FREE_TWICE:
        return fork_made(call, NULL, args->deed);
    case GET:
        return duite_get(call->rt, own, values);
    case GET_NOWHERE:
        return duite_get(call->rt, own, NULL);
    case GET_COUNT:
        return duite_get_count(call->rt, own, &count);
    case OVERWRITE:
        return duite_set(call->rt, own, values);
    case SET_SIZED:
        return duite_set_sized(call->rt, own, values, 3);
    case RESIZE:
        return duite_resize(call, 0, 1);
    case CONTRIBUTE:
        return duite_contribute(call, 0) ? DUITE_OK : DUITE_E_RIGHT;
    case CONTRIBUTE_BEYOND:
        return duite_contribute(call, 1) ? DUITE_OK : DUITE_E_RIGHT;
    case NEW_NOWHERE:
        return duite_new(call->rt, DUITE_I32, 1, NULL);
    case NEW_EMPTY:
        return duite_new(call->rt, DUITE_I32, 0, &made);
    case NEW_SIZED:
        return duite_new_sized(call->rt, DUITE_I32, 3, 2, &made);
    default:
        return fork_something(call, args);
    }
}

static int parent(const duite_call *call)
{
    const struct args *args = call->args;

    told = ask(call, args);
    snprintf(sentence, sizeof sentence, "%s", told ? duite_message() : "");
    if (call->n_params)
        stale = call->param[0].object;
    return args->then == 1 ? (duite_wait(call->rt), 0) : args->then;
}

static void name_kernels(void)
{
    for (int i = 0; i <= MODES; i++) {
        snprintf(names[0][i], sizeof names[0][i], "parent %s", MODE[i]);
        snprintf(names[1][i], sizeof names[1][i], "child %s", MODE[i]);
        parents[i] = (duite_kernel){.name = names[0][i],
                                    .body = parent,
                                    .access = {(uint8_t)i},
                                    .args_size = sizeof(struct args)};
        children[i] = (duite_kernel){.name = names[1][i], .body = child, .access = {(uint8_t)i}};
    }
}

static void begin(void)
{
    const duite_kernel *list[2 * (MODES + 1) + 8];
    duite_options options = misuse_options(MPI_COMM_WORLD);
    size_t n = 0;

    misuse_mpi();
    name_kernels();
    for (int i = 0; i <= MODES; i++) {
        list[n++] = &parents[i];
        list[n++] = &children[i];
    }
    list[n++] = &LEAST;
    list[n++] = &LEAST_POSTPONED;
    list[n++] = &TWO;
    list[n] = NULL;
    options.kernels = list;
    ck_assert_msg(duite_start(&rt, &options) == DUITE_OK, "%s", duite_message());
    object = misuse_new(rt, 4);
    foreign = misuse_new(rt, 4);
}

static void end(void)
{
    duite_free(rt, object);
    duite_free(rt, foreign);
    ck_assert_int_eq(duite_stop(&rt), DUITE_OK);
}

/* A parent in that mode asks and is told the code and the sentence; so is the main program, unless
 * the body asked what there is to be told. */
static void asks(duite_mode mode, struct args args, int code, const char *what)
{
    told = 77;
    ck_assert_int_eq(duite_fork(rt, &parents[mode], &args, mode != DUITE_NONE, &object), DUITE_OK);
    const int waited = duite_wait(rt);

    ck_assert_msg(told == code, "mode %s, deed %d, child %s: code %d, not %d: %s", MODE[mode],
                  (int)args.deed, MODE[args.child], told, code, sentence);
    unit_says(sentence, what);
    if (code && args.deed != GET && args.deed != GET_NOWHERE && args.deed != GET_COUNT) {
        ck_assert_int_eq(waited, code);
        unit_says(duite_message(), what);
    } else {
        ck_assert_int_eq(waited, DUITE_OK);
    }
    duite_set(rt, object, NULL);
}

UNIT_FIXTURE(begin, end)

/* The table of duite_mode, as the contract has it. */
UNIT_TEST(rights)
{
    static const char *const GIVES[] = {
        "", "r rp", "", "", "", "r rp", "w wp", "r w rw cw rp wp rwp cwp", "cw cwp"};
    for (int held = DUITE_R; held <= MODES; held++)
        for (int wanted = DUITE_R; wanted <= MODES; wanted++) {
            char list[40], entry[8], what[120];

            snprintf(list, sizeof list, " %s ", GIVES[held]);
            snprintf(entry, sizeof entry, " %s ", MODE[wanted]);
            const bool may = strstr(list, entry) != NULL;

            snprintf(what, sizeof what, "the task holds %s on object", MODE[held]);
            asks((duite_mode)held, (struct args){.deed = FORK, .child = (duite_mode)wanted},
                 may ? DUITE_OK : DUITE_E_RIGHT, may ? "" : what);
            snprintf(what, sizeof what, "of its kernel parent %s, and %s is wanted", MODE[held],
                     MODE[wanted]);
            unit_says(may ? what : sentence, what);
        }
}

UNIT_TEST(other_objects)
{
    const struct args args = {.child = DUITE_RW};
    struct args with = args;

    with.deed = FORK;
    asks(DUITE_RWP, with, DUITE_OK, "");
    with.deed = FORK_STALE;
    asks(DUITE_RWP, with, DUITE_E_OBJECT, "was freed, or is another task's");
    with.deed = FORK_FOREIGN;
    asks(DUITE_RWP, with, DUITE_E_RIGHT, "holds no right on object");
    unit_says(sentence, "of the main program, rw is wanted");
    with.deed = FORK_FREED;
    asks(DUITE_NONE, with, DUITE_E_OBJECT, "was freed, or is another task's");
    with.deed = FREE_TWICE;
    asks(DUITE_NONE, with, DUITE_E_OBJECT, "duite_free, parameter 0: object");
    with.deed = FORK_NONE;
    asks(DUITE_NONE, with, DUITE_E_OBJECT, "names nothing");
    with.deed = FORK_TWICE;
    asks(DUITE_NONE, with, DUITE_E_ACCESS, "twice");
    with.deed = FORK_UNLISTED;
    asks(DUITE_RWP, with, DUITE_E_KERNEL, "not listed");
    with.deed = FORK_AT;
    asks(DUITE_RWP, with, DUITE_E_STATE, "the children of a task run on its rank (0)");
    with.deed = FORK_WITH_ARGUMENTS;
    asks(DUITE_RWP, with, DUITE_E_ARGUMENT, "kernel child rw has no arguments");
    with.deed = FREE;
    asks(DUITE_RWP, with, DUITE_E_RIGHT, "duite_free: the object is the caller's");
    asks(DUITE_WP, with, DUITE_E_RIGHT, "duite_free, parameter 0: the task holds wp");
}

/* A body that goes on after a refused call fails with that one, whatever it is refused later. */
UNIT_TEST(the_first_refusal_counts)
{
    const struct args args = {.deed = FORK_UNLISTED_THEN_TWICE};

    ck_assert_int_eq(DUITE_FORK(rt, &parents[DUITE_RWP], &args, object), DUITE_OK);
    ck_assert_int_eq(duite_wait(rt), DUITE_E_KERNEL);
    unit_says(duite_message(), "not listed");
    ck_assert_int_eq(told, DUITE_E_ACCESS);
    duite_set(rt, object, NULL);
}

UNIT_TEST(other_law)
{
    asks(DUITE_CWP, (struct args){.deed = FORK_OTHER_LAW, .child = DUITE_CW}, DUITE_E_RIGHT,
         "the task holds cwp by law sum on object");
    asks(DUITE_CWP, (struct args){.deed = FORK_OTHER_LAW, .child = DUITE_CWP}, DUITE_E_RIGHT,
         "and law min is wanted");
    asks(DUITE_RWP, (struct args){.deed = FORK_OTHER_LAW, .child = DUITE_CW}, DUITE_OK, "");
}

UNIT_TEST(reading_and_setting)
{
    static const int READS[] = {0, 1, 0, 0, 0, 1, 0, 1, 0}, SETS[] = {0, 0, 0, 0, 0, 0, 1, 1, 0};

    for (int held = DUITE_R; held <= MODES; held++) {
        asks((duite_mode)held, (struct args){.deed = GET}, READS[held] ? DUITE_OK : DUITE_E_RIGHT,
             READS[held] ? "" : "duite_get, parameter 0: the task holds");
        asks((duite_mode)held, (struct args){.deed = GET_COUNT},
             READS[held] ? DUITE_OK : DUITE_E_RIGHT, READS[held] ? "" : "duite_get_count");
        asks((duite_mode)held, (struct args){.deed = OVERWRITE},
             SETS[held] ? DUITE_OK : DUITE_E_RIGHT,
             SETS[held] ? "" : "duite_set, parameter 0: the task holds");
    }
    asks(DUITE_RP, (struct args){.deed = GET_NOWHERE}, DUITE_E_ARGUMENT, "nowhere to put");
    asks(DUITE_RWP, (struct args){.deed = SET_SIZED}, DUITE_E_SIZE, "3 elements, and object");
    asks(DUITE_RWP, (struct args){.deed = RESIZE}, DUITE_E_SIZE, "has a fixed size");
}

UNIT_TEST(resizing_what_is_postponed)
{
    const struct args args = {.deed = RESIZE};
    duite_object sized;

    duite_new_sized(rt, DUITE_I32, 1, 4, &sized);
    DUITE_FORK(rt, &parents[DUITE_RWP], &args, sized);
    ck_assert_int_eq(duite_wait(rt), DUITE_E_SIZE);
    unit_says(sentence, "parameter 0 is its children's alone");
    duite_free(rt, sized);
}

/* A body that goes on as if it had been given something fails, too. */
UNIT_TEST(contributing)
{
    char what[120];

    for (int held = DUITE_R; held <= MODES; held++) {
        const int code = held == DUITE_CWP ? DUITE_OK : DUITE_E_RIGHT;

        snprintf(what, sizeof what,
                 "duite_contribute: the task holds %s on parameter 0, cwp is wanted", MODE[held]);
        asks((duite_mode)held, (struct args){.deed = CONTRIBUTE}, code, code ? what : "");
    }
    asks(DUITE_CWP, (struct args){.deed = CONTRIBUTE_BEYOND}, DUITE_E_RIGHT,
         "duite_contribute: there is no parameter 1, only 1");
    asks(DUITE_NONE, (struct args){.deed = CONTRIBUTE}, DUITE_E_RIGHT, "no parameter 0, only 0");
}

UNIT_TEST(making)
{
    asks(DUITE_NONE, (struct args){.deed = NEW_NOWHERE}, DUITE_E_ARGUMENT,
         "duite_new: nowhere to put");
    asks(DUITE_NONE, (struct args){.deed = NEW_EMPTY}, DUITE_E_ARGUMENT, "at least one element");
    asks(DUITE_NONE, (struct args){.deed = NEW_SIZED}, DUITE_E_ARGUMENT,
         "3 elements are more than 2 at most");
}

/* An error that the body could look at is told by its wait, and then not held against it; its own
 * code goes before. */
UNIT_TEST(looked_at)
{
    struct args args = {.deed = FORK_FOREIGN, .child = DUITE_R, .then = 1};

    DUITE_FORK(rt, &parents[DUITE_RWP], &args, object);
    ck_assert_int_eq(duite_wait(rt), DUITE_OK);
    ck_assert_int_eq(told, DUITE_E_RIGHT);
    args.then = 33;
    DUITE_FORK(rt, &parents[DUITE_RWP], &args, object);
    ck_assert_int_eq(duite_wait(rt), 33);
    args.then = DUITE_E_RIGHT;
    duite_set(rt, object, NULL);
    DUITE_FORK(rt, &parents[DUITE_RWP], &args, object);
    ck_assert_int_eq(duite_wait(rt), DUITE_E_RIGHT);
    unit_says(duite_message(), "holds no right");
}
