#ifndef CLOTH_BASE_BYTES_H
#define CLOTH_BASE_BYTES_H

#include <float.h>
#include <math.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

/* Numbers in the bytes of files and messages, little-endian whatever the machine. */

static inline void cloth_put_u32(unsigned char *bytes, uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(value >> (8 * i) & 0xff);
}

static inline uint32_t cloth_get_u32(const unsigned char *bytes)
{
    return (uint32_t)bytes[0] | (uint32_t)bytes[1] << 8 | (uint32_t)bytes[2] << 16 |
           (uint32_t)bytes[3] << 24;
}

static inline void cloth_put_u64(unsigned char *bytes, uint64_t value)
{
    cloth_put_u32(bytes, (uint32_t)value);
    cloth_put_u32(bytes + 4, (uint32_t)(value >> 32));
}

static inline uint64_t cloth_get_u64(const unsigned char *bytes)
{
    return cloth_get_u32(bytes) | (uint64_t)cloth_get_u32(bytes + 4) << 32;
}

static inline void cloth_put_float(unsigned char *bytes, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    cloth_put_u32(bytes, bits);
}

static inline float cloth_get_float(const unsigned char *bytes)
{
    const uint32_t bits = cloth_get_u32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

static inline void cloth_put_double(unsigned char *bytes, double value)
{
    uint64_t bits;
    memcpy(&bits, &value, sizeof bits);
    cloth_put_u64(bytes, bits);
}

static inline double cloth_get_double(const unsigned char *bytes)
{
    const uint64_t bits = cloth_get_u64(bytes);
    double value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

/* Puts n points, each as three floats; x: `stride` doubles from one to the next. Returns how many
 * come before the first one that is not finite as float, where it stops. */
static inline size_t cloth_put_points(unsigned char *bytes, size_t n, const double *x,
                                      size_t stride)
{
    for (size_t i = 0; i < 3 * n; i++) {
        const double value = x[i / 3 * stride + i % 3];
        if (!(fabs(value) <= (double)FLT_MAX))
            return i / 3;
        cloth_put_float(bytes + 4 * i, (float)value);
    }
    return n;
}

#endif
