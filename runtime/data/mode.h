#ifndef DUITE_DATA_MODE_H
#define DUITE_DATA_MODE_H

#include <duite.h>

/* The mode of parameter i of a kernel; DUITE_NONE: it has none. */
static inline duite_mode data_mode_of(const duite_kernel *kernel, size_t i)
{
    duite_mode mode = i < DUITE_MAX_ACCESS ? kernel->access[i] : DUITE_NONE;
    return mode != DUITE_NONE ? mode : kernel->variadic;
}

#endif
