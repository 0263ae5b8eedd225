/* The arithmetic of every random body. Its output depends on every byte it reads, on their order
 * and on its seed and round; floating-point values differ in magnitude so much that another
 * summation tree leaves other bits, and stay far from infinity, since the bits of a NaN are
 * nobody's promise. */

#include "tests/runtime/random_program.h"

#include <sched.h>
#include <stdlib.h>
#include <string.h>

size_t prog_size(duite_type type)
{
    switch (type) {
    case DUITE_BYTE:
        return 1;
    case DUITE_U16:
        return 2;
    case DUITE_CF64:
        return 16;
    case DUITE_I32:
    case DUITE_F32:
        return 4;
    case DUITE_I64:
    case DUITE_F64:
        return 8;
    default:
        return 0;
    }
}

static uint64_t digest(uint64_t hash, const void *data, size_t size)
{
    const unsigned char *bytes = data;

    for (size_t i = 0; i < size; i += 8) {
        uint64_t word = 0;

        memcpy(&word, bytes + i, size - i < 8 ? size - i : 8);
        hash = (hash ^ word) * 0x9fb21c651e98df25u;
        hash ^= hash >> 29;
    }
    return (hash ^ size) * 0xff51afd7ed558ccdu;
}

/* +- 2^-20 .. 2^21 with a full mantissa. */
static double double_of(uint64_t bits)
{
    const uint64_t exponent = 1023 - 20 + (bits >> 52 & 0x7ff) % 41;
    const uint64_t raw = (bits & 0x800fffffffffffffu) | exponent << 52;
    double value;

    memcpy(&value, &raw, sizeof value);
    return value;
}

/* +- 2^-12 .. 2^13. */
static float float_of(uint64_t bits)
{
    const uint32_t exponent = (uint32_t)(127 - 12 + (bits >> 32 & 0xff) % 25);
    const uint32_t raw = ((uint32_t)bits & 0x807fffffu) | exponent << 23;
    float value;

    memcpy(&value, &raw, sizeof value);
    return value;
}

/* Element i becomes bits (w), is mixed with them (rw), or they are added to it (cw; under min and
 * max it becomes them). */
static void put(duite_type type, duite_mode mode, void *data, size_t i, uint64_t bits)
{
    uint8_t *byte = data;
    uint32_t *word = data;
    uint64_t *big = data;
    float *f32 = data;
    double *f64 = data;
    uint16_t *half = data;
    const unsigned odd = mode == DUITE_W ? 0 : mode == DUITE_RW ? 17 : 1;

    switch (type) {
    case DUITE_BYTE:
        byte[i] = (uint8_t)(odd ? byte[i] * odd + bits : bits);
        break;
    case DUITE_U16:
        half[i] = (uint16_t)(odd ? half[i] * odd + bits : bits);
        break;
    case DUITE_CF64:
        put(DUITE_F64, mode, f64, 2 * i, bits);
        put(DUITE_F64, mode, f64, 2 * i + 1, bits * 5 + 1);
        break;
    case DUITE_I32:
        word[i] = odd ? word[i] * odd + (uint32_t)bits : (uint32_t)bits;
        break;
    case DUITE_I64:
        big[i] = odd ? big[i] * odd + bits : bits;
        break;
    case DUITE_F32:
        f32[i] = !odd ? float_of(bits) : (odd == 1 ? f32[i] : f32[i] * 0.5f) + float_of(bits);
        break;
    case DUITE_F64:
        f64[i] = !odd ? double_of(bits) : (odd == 1 ? f64[i] : f64[i] * 0.5) + double_of(bits);
        break;
    default:
        break;
    }
}

void prog_values(duite_type type, size_t count, uint64_t seed, void *values)
{
    for (size_t i = 0; i < count; i++)
        put(type, DUITE_W, values, i, duite_random(&seed));
}

static void waste(unsigned pause)
{
    if (pause == 1)
        sched_yield();
    for (volatile unsigned i = 0; i < pause; i++)
        ;
}

static int is_neutral(const struct prog_args *args, const duite_param *param, size_t i)
{
    const size_t bytes = param->count * prog_size(param->type);
    void *neutral = malloc(bytes);

    if (!neutral)
        return 1;
    prog_neutral((enum prog_law)args->law[i], param->type, param->count, neutral);
    const int same = !memcmp(param->data, neutral, bytes);

    free(neutral);
    return same;
}

/* Returns whether a parameter has its own size; or, if that changes, its maximum under w and
 * postponed. */
static int has_size(const struct prog_args *args, const duite_param *param, size_t i)
{
    const size_t max = args->max[i] ? args->max[i] : args->count[i];
    const duite_mode mode = (duite_mode)args->mode[i];

    if (param->count > max || (!prog_is_postponed(mode) && param->max != max))
        return 0;
    return param->count == max || (args->max[i] && mode != DUITE_W && !prog_is_postponed(mode));
}

/* Adopted memory is aligned to its elements. */
static size_t alignment(const struct prog_args *args, const duite_param *param)
{
    const size_t size = prog_size(param->type);

    return !args->adopts ? 64 : size < 8 ? size : 8;
}

/* The line of the first promise that is broken about a parameter; 0 if none is. */
static int broken_parameter(const duite_call *call, const struct prog_args *args, size_t i)
{
    const duite_param *param = &call->param[i];

    if (prog_is_postponed((duite_mode)args->mode[i]) != !param->data)
        return __LINE__;
    if ((uintptr_t)param->data % alignment(args, param) != 0)
        return __LINE__;
    if (!has_size(args, param, i) || param->type != args->type[i])
        return __LINE__;
    for (size_t j = 0; param->data && j < i; j++)
        if (param->data == call->param[j].data)
            return __LINE__;
    if (args->mode[i] == DUITE_CW && !is_neutral(args, param, i))
        return __LINE__;
    return 0;
}

/* The same of the call. */
static int broken(const duite_call *call, const struct prog_args *args,
                  const struct prog_context *context)
{
    if (call->n_params != args->n)
        return __LINE__;
    if (call->rank != context->rank || (args->rank >= 0 && args->rank != call->rank))
        return __LINE__;
    if (call->worker >= context->threads)
        return __LINE__;
    for (size_t i = 0; i < call->n_params; i++)
        if (broken_parameter(call, args, i))
            return broken_parameter(call, args, i);
    return 0;
}

void prog_body_wrong(struct prog_context *context, int line, int code)
{
    int none = 0;

    if (atomic_compare_exchange_strong(&context->wrong, &none, line))
        atomic_store(&context->code, code);
}

static void watch(const duite_call *call, const struct prog_args *args,
                  struct prog_context *context)
{
    const int line = broken(call, args, context);

    if (line)
        prog_body_wrong(context, line, 0);
    atomic_fetch_add(&context->ran[args->number], 1);
    waste(args->pause);
}

/* The parameter gets another size; in the interpreter, which leaves room, by hand. */
static void resize(const duite_call *call, size_t i, size_t count)
{
    const size_t size = prog_size(call->param[i].type);
    duite_param *param = (duite_param *)&call->param[i];

    if (call->context) {
        if (duite_resize(call, i, count) || duite_count(call, i) != count)
            prog_body_wrong(call->context, __LINE__, 0);
        return;
    }
    if (count > param->count)
        memset((char *)param->data + param->count * size, 0, (count - param->count) * size);
    param->count = count;
}

/* A size that follows from the hash, by way of another one at times; returns how many elements the
 * body writes: the others are zero. */
static size_t change_size(const duite_call *call, size_t i, size_t max, uint64_t hash)
{
    const size_t count = hash / 7 % (max + 1);

    if (hash % 7 < 2)
        return duite_count(call, i);
    if (hash % 7 == 3) {
        resize(call, i, count / 2);
        resize(call, i, count);
        return count / 2;
    }
    resize(call, i, count);
    return count;
}

/* Asks for what it may not have; at times it says so itself. */
static int exceed(const duite_call *call, const struct prog_args *args)
{
    const size_t i = args->exceeds - 1;

    if (!call->context)
        return DUITE_E_SIZE;
    if (duite_resize(call, i, call->param[i].max + 1) != DUITE_E_SIZE)
        prog_body_wrong(call->context, __LINE__, 0);
    return args->seed % 2 ? DUITE_E_SIZE : DUITE_OK;
}

uint64_t prog_body_begin(const duite_call *call)
{
    const struct prog_args *args = call->args;
    uint64_t hash = args->seed + call->round;

    if (call->context)
        watch(call, args, call->context);
    for (size_t i = 0; i < args->n; i++)
        if (args->mode[i] == DUITE_R || args->mode[i] == DUITE_RW)
            hash =
                digest(hash, call->param[i].data, duite_count(call, i) * prog_size(args->type[i]));
    return hash;
}

uint64_t prog_body_told(uint64_t hash, int code, const void *bytes, size_t n)
{
    return digest(digest(hash, &code, sizeof code), bytes, n);
}

/* Writes parameter i. */
static void write_parameter(const duite_call *call, size_t i, uint64_t hash)
{
    const struct prog_args *args = call->args;
    const size_t stride = args->mode[i] == DUITE_CW && hash % 4 == 0 ? 3 : 1;
    const int extreme = args->law[i] == PROG_MIN || args->law[i] == PROG_MAX;
    const duite_mode mode = extreme ? DUITE_W : (duite_mode)args->mode[i];
    uint64_t state = hash + i;
    const size_t count =
        args->max[i] ? change_size(call, i, args->max[i], state / 3) : duite_count(call, i);

    for (size_t e = 0; e < count; e += stride)
        put(args->type[i], mode, call->param[i].data, e, duite_random(&state));
    if (args->ends && args->mode[i] != DUITE_CW && hash % 3 == 0)
        memset(call->param[i].data, 0, prog_size(args->type[i]));
}

int prog_body_end(const duite_call *call, uint64_t hash)
{
    const struct prog_args *args = call->args;

    for (size_t i = 0; i < args->n; i++)
        if (args->mode[i] != DUITE_R && !prog_is_postponed((duite_mode)args->mode[i]))
            write_parameter(call, i, hash);
    if (args->exceeds)
        return exceed(call, args);
    if (args->sometimes && hash % 4 != 1)
        return 0;
    if (args->fails && call->context)
        return duite_fail(call, args->fails, "fork %u fails", args->number);
    return args->fails;
}

void prog_args_fill(const struct prog *prog, const struct prog_op *op,
                    const struct prog_object *shape, struct prog_args *args)
{
    memset(args, 0, sizeof *args);
    args->seed = op->seed;
    args->body = op->body;
    args->n_inner = op->n_inner;
    args->fails = op->fails;
    args->exceeds = op->exceeds;
    args->sometimes = op->sometimes != 0;
    args->ends = op->ends != 0;
    args->holds = prog->kernel[op->kernel].events != 0;
    args->adopts = prog->adopts != 0;
    args->rank = op->rank;
    args->pause = op->pause;
    args->number = op->number;
    args->n = op->n;
    for (unsigned i = 0; i < op->n; i++) {
        args->count[i] = (uint32_t)shape[op->objects[i]].count;
        args->max[i] = (uint32_t)shape[op->objects[i]].max;
        args->type[i] = (uint8_t)shape[op->objects[i]].type;
        args->mode[i] = (uint8_t)prog_mode(&prog->kernel[op->kernel], i);
        args->law[i] = (uint8_t)prog_law(&prog->kernel[op->kernel], i);
    }
}

void prog_shapes(const struct prog_args *args, struct prog_object *shape)
{
    for (unsigned i = 0; i < args->n; i++)
        shape[i] =
            (struct prog_object){(duite_type)args->type[i], args->count[i], args->max[i], -1, 0};
}
