#ifndef DUITE_DATA_LAW_H
#define DUITE_DATA_LAW_H

#include <duite.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* A kernel's parameters: element types, modes and laws. */

/* Element types: bytes of an element, 0 for an invalid type; the type's name in messages. */
static inline size_t data_type_size(duite_type type)
{
    static const unsigned char size[] = {
        [DUITE_BYTE] = 1, [DUITE_I8] = 1,   [DUITE_U8] = 1,   [DUITE_I16] = 2, [DUITE_U16] = 2,
        [DUITE_I32] = 4,  [DUITE_U32] = 4,  [DUITE_F32] = 4,  [DUITE_I64] = 8, [DUITE_U64] = 8,
        [DUITE_F64] = 8,  [DUITE_CF32] = 8, [DUITE_CF64] = 16};
    return (size_t)type < sizeof size ? size[type] : 0;
}
const char *data_type_name(duite_type type);

/* ---- Modes ---- */

/* The mode of parameter i of a kernel; DUITE_NONE: it has none. */
static inline duite_mode data_mode_of(const duite_kernel *kernel, size_t i)
{
    const uint8_t mode = i < DUITE_MAX_ACCESS ? kernel->access[i] : DUITE_NONE;
    return mode != DUITE_NONE ? (duite_mode)mode : kernel->variadic;
}

/* The modes that a kernel lists. */
static inline size_t data_modes_listed(const duite_kernel *kernel)
{
    size_t n = 0;
    while (n < DUITE_MAX_ACCESS && kernel->access[n] != DUITE_NONE)
        n++;
    return n;
}

/* ---- Laws ---- */

/* Contributions combine by laws. A kernel points at the laws of its cw parameters; each is built in
 * or in the list given at start. */

/* Checks that the listed laws are complete and that their names are unique, also among the built-in
 * ones. `laws` NULL: none are listed. Error: DUITE_E_LAW. */
int data_laws_check(const duite_law *const *laws);

/* The law that the kernel names for parameter i, which has a mode; NULL: none. */
static inline const duite_law *data_law_named(const duite_kernel *kernel, size_t i)
{
    return kernel->law ? kernel->law[i] : NULL;
}

/* Checks that the kernel names laws only for cw and cwp parameters, each built in or listed. Its
 * modes were checked before. Error: DUITE_E_LAW. */
int data_law_check_kernel(const duite_kernel *kernel, const duite_law *const *laws);

/* The law of parameter i, which is cw. Never NULL. */
static inline const duite_law *data_law_of(const duite_kernel *kernel, size_t i)
{
    const bool listed = i < DUITE_MAX_ACCESS && kernel->access[i] != DUITE_NONE;
    const duite_law *law = listed ? data_law_named(kernel, i) : kernel->variadic_law;
    return law ? law : &duite_sum;
}

/* Writes the law's neutral elements. */
void data_law_neutral(const duite_law *law, void *values, size_t count, duite_type type);

/* Objects that the law is for: the types in words, and whether one of them is this one. */
const char *data_law_types(const duite_law *law);
bool data_law_fits(const duite_law *law, duite_type type);

/* Hashes the names and types of the listed laws, and of the laws that a kernel names. */
uint64_t data_laws_hash(const duite_law *const *laws, uint64_t hash);
uint64_t data_law_hash_kernel(const duite_kernel *kernel, uint64_t hash);

#endif
