/* The arithmetic of bodies (nested_program.h), which the interpreter shares. Numbers are mixed so
 * that another order of reads, writes or additions shows. */
#include "tests/runtime/nested_program.h"

size_t nest_size(duite_type type)
{
    return type == DUITE_F64 || type == DUITE_I64 ? 8 : 4;
}

uint64_t nest_mix(uint64_t digest, const void *bytes, size_t n)
{
    for (size_t i = 0; i < n; i++) {
        uint64_t state = digest ^ ((const unsigned char *)bytes)[i];

        digest = duite_random(&state);
    }
    return digest;
}

/* Numbers of very different sizes, so that another order of additions shows. */
void nest_values(duite_type type, size_t count, uint64_t seed, void *values)
{
    for (size_t i = 0; i < count; i++) {
        const uint64_t random = duite_random(&seed);
        const int scale = (int)(random >> 60);
        const double value =
            (double)((int64_t)(random << 8) >> 8) / (double)(UINT64_C(1) << (20 + 2 * scale));

        if (type == DUITE_F64)
            ((double *)values)[i] = value;
        else if (type == DUITE_F32)
            ((float *)values)[i] = (float)value;
        else if (type == DUITE_I32)
            ((uint32_t *)values)[i] = (uint32_t)random;
        else
            ((uint64_t *)values)[i] = random;
    }
}

uint64_t nest_read(const struct nest_task *task, const duite_param *param)
{
    uint64_t digest = task->seed;

    for (unsigned i = 0; i < task->n; i++)
        if (param[i].data && task->mode[i] != DUITE_W && task->mode[i] != DUITE_CW)
            digest = nest_mix(digest, param[i].data, param[i].count * nest_size(param[i].type));
    return digest;
}

size_t nest_count(const struct nest_task *task, const duite_param *param, unsigned i,
                  uint64_t digest)
{
    const bool writes = task->mode[i] == DUITE_W || task->mode[i] == DUITE_RW;

    if (!task->sized[i] || !writes)
        return param[i].count;
    digest += i;
    return duite_random(&digest) % (param[i].max + 1);
}

void nest_law(void *left, const void *right, size_t count, duite_type type)
{
    for (size_t i = 0; i < count; i++)
        if (type == DUITE_F64)
            ((double *)left)[i] = 0.5 * ((double *)left)[i] + ((const double *)right)[i];
        else if (type == DUITE_F32)
            ((float *)left)[i] = 0.5f * ((float *)left)[i] + ((const float *)right)[i];
        else if (type == DUITE_I32)
            ((uint32_t *)left)[i] = 3 * ((uint32_t *)left)[i] + ((const uint32_t *)right)[i];
        else
            ((uint64_t *)left)[i] = 3 * ((uint64_t *)left)[i] + ((const uint64_t *)right)[i];
}

void nest_write(const struct nest_task *task, const duite_param *param, uint64_t digest)
{
    for (unsigned i = 0; i < task->n; i++)
        if (param[i].data && task->mode[i] != DUITE_R)
            nest_values(param[i].type, param[i].count, digest + i, param[i].data);
}
