/* Memory of the program's own, and its turns on objects. */

#include "tests/runtime/random_run.h"

#include <stdlib.h>
#include <string.h>

enum { GUARD = 64, UNTOUCHED = 0x77 };

static void given_back(void *values, void *user)
{
    struct run_memory *memory = user;

    if (values == memory->values)
        atomic_fetch_add(&memory->given_back, 1);
}

static size_t value_bytes(const struct prog_object *object)
{
    return object->count * prog_size(object->type);
}

/* Aligned to the elements, and now and then no better. */
static void make_memory(struct run_memory *memory, const struct prog_object *object, uint64_t seed)
{
    const size_t size = prog_size(object->type), align = size < 8 ? size : 8;
    const size_t bytes = value_bytes(object) + 3 * GUARD;

    memory->block = prog_memory(bytes, 1);
    memset(memory->block, UNTOUCHED, bytes);
    memory->values = memory->block + GUARD + seed % 8 * align;
    prog_values(object->type, object->count, seed, memory->values);
}

int prog_call_adopt(struct run *run, const struct prog_op *op)
{
    struct run_scope *main = &run->main;
    struct run_memory *memory = &run->memory[op->object];

    if (op->rank == main->rank)
        make_memory(memory, &main->shape[op->object], op->seed);
    return duite_adopt(main->rt, op->rank, op->type, op->count, memory->values, given_back, memory,
                       &main->name[op->object]);
}

void prog_call_acquire(struct run *run, const struct prog_op *op, const struct prog_expect *answer)
{
    struct run_scope *main = &run->main;
    struct run_turn *turn = &run->turn[op->object];
    const struct prog_object *object = &main->shape[op->object];
    const void *adopted = run->memory[op->object].values;
    const int code = duite_acquire(main->rt, main->name[op->object], op->mode, &turn->data);
    const int here = duite_home(main->rt, main->name[op->object]) == main->rank;

    *turn = (struct run_turn){.acquired = 1,
                              .mode = op->mode,
                              .data = turn->data,
                              .count = op->mode == DUITE_W ? op->count : answer->count,
                              .seed = op->seed};
    prog_expect_code(run, "acquire", code, here ? answer->code : DUITE_OK);
    if ((here && !answer->code) != (turn->data != NULL))
        prog_found(run, "object %u is%s acquired here", op->object, turn->data ? "" : " not");
    if (turn->data && adopted && turn->data != adopted)
        prog_found(run, "object %u is not where its memory is", op->object);
    if (turn->data && answer->bytes &&
        memcmp(turn->data, answer->bytes, answer->count * prog_size(object->type)) != 0)
        prog_found(run, "object %u has other values in its turn", op->object);
}

/* A turn that was left out has no release. */
void prog_call_release(struct run *run, const struct prog_op *op)
{
    struct run_turn *turn = &run->turn[op->object];

    if (!turn->acquired)
        return;
    turn->acquired = 0;
    if (turn->data && turn->mode != DUITE_R)
        prog_values(run->main.shape[op->object].type, turn->count, turn->seed, turn->data);
    prog_expect_code(run, "release", duite_release(run->main.rt, run->main.name[op->object]),
                     DUITE_OK);
}

static int is_untouched(const unsigned char *bytes, const unsigned char *end)
{
    while (bytes < end && *bytes == UNTOUCHED)
        bytes++;
    return bytes == end;
}

static void check_values(struct run *run, unsigned number)
{
    const struct run_memory *memory = &run->memory[number];
    const size_t bytes = value_bytes(&run->main.shape[number]);
    const unsigned char *values = memory->values, *last = NULL;

    if (memory->freed)
        last = run->answers->op[memory->freed - 1].bytes;
    if (last && memcmp(values, last, bytes) != 0)
        prog_found(run, "object %u left another value in its memory", number);
    if (!is_untouched(memory->block, values) ||
        !is_untouched(values + bytes, memory->block + bytes + 3 * GUARD))
        prog_found(run, "object %u: bytes beyond its memory were written", number);
}

void prog_check_memory(struct run *run, int wait)
{
    for (unsigned i = 0; i < run->prog->n_objects; i++) {
        struct run_memory *memory = &run->memory[i];
        const int times = atomic_load(&memory->given_back);

        if (!memory->block || (wait && !memory->freed))
            continue;
        if (times != 1)
            prog_found(run, "the memory of object %u was given back %d times", i, times);
        check_values(run, i);
        if (!wait)
            free(memory->block);
    }
}
