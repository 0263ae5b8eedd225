#ifndef DUITE_DATA_LAW_H
#define DUITE_DATA_LAW_H

#include <duite.h>

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* What a kernel says of its parameters: element types, modes and laws. */

/* Element types: bytes of an element, 0 for no type; their name in a message. */
static inline size_t data_type_size(duite_type type)
{
    static const unsigned char size[] = {
        [DUITE_BYTE] = 1, [DUITE_I32] = 4, [DUITE_I64] = 8, [DUITE_F32] = 4, [DUITE_F64] = 8};
    return (size_t)type < sizeof size ? size[type] : 0;
}
const char *data_type_name(duite_type type);

/* ---- Modes ---- */

/* The mode of parameter i of a kernel; DUITE_NONE: it has none. */
static inline duite_mode data_mode_of(const duite_kernel *kernel, size_t i)
{
    duite_mode mode = i < DUITE_MAX_ACCESS ? kernel->access[i] : DUITE_NONE;
    return mode != DUITE_NONE ? mode : kernel->variadic;
}

/* ---- Laws ---- */

/* Laws by which contributions combine. A kernel points at the laws of its cw parameters; all of
 * them were found in the list given at start, or are built in. */

/* The laws of the list are whole and have different names, none that of a built-in one. `laws` may
 * be NULL: none. DUITE_E_LAW. */
int data_laws_check(const duite_law *const *laws);

/* The kernel, whose modes were checked, names laws for cw parameters only, each built in or listed.
 * DUITE_E_LAW. */
int data_law_check_kernel(const duite_kernel *kernel, const duite_law *const *laws);

/* The law of parameter i, which is cw. Never NULL. */
const duite_law *data_law_of(const duite_kernel *kernel, size_t i);

/* Writes the law's neutral elements. */
void data_law_neutral(const duite_law *law, void *values, size_t count, duite_type type);

/* Whether the law is for objects of this type. */
bool data_law_fits(const duite_law *law, duite_type type);

/* Of names and types: the laws listed, and those a kernel names. */
uint64_t data_laws_hash(const duite_law *const *laws, uint64_t hash);
uint64_t data_law_hash_kernel(const duite_kernel *kernel, uint64_t hash);

#endif
