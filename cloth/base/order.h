#ifndef CLOTH_BASE_ORDER_H
#define CLOTH_BASE_ORDER_H

#include <stddef.h>
#include <stdint.h>

/* Compares two numbers for qsort: below 0, 0 or above 0. Their difference might overflow. */
static inline int cloth_compare_u32(uint32_t a, uint32_t b)
{
    return (a > b) - (a < b);
}

/* The same of two of an array, for qsort. */
static inline int cloth_compare_items_u32(const void *a, const void *b)
{
    return cloth_compare_u32(*(const uint32_t *)a, *(const uint32_t *)b);
}

static inline size_t cloth_larger(size_t a, size_t b)
{
    return a > b ? a : b;
}
static inline size_t cloth_smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

#endif
