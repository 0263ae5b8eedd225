/* PC2: char[12] "POINTCACHE2\0", int32 version, int32 points, float start frame, float sample rate,
 * int32 frames, then float x y z a point and frame; little-endian. Only the count of frames ever
 * changes in a header. */
#include "cloth/output/files/files.h"

#include <string.h>

void output_put_u32(unsigned char bytes[4], uint32_t value)
{
    for (int i = 0; i < 4; i++)
        bytes[i] = (unsigned char)(value >> (8 * i) & 0xff);
}

uint32_t output_get_u32(const unsigned char bytes[4])
{
    uint32_t value = 0;
    for (int i = 0; i < 4; i++)
        value |= (uint32_t)bytes[i] << (8 * i);
    return value;
}

void output_put_float(unsigned char bytes[4], float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    output_put_u32(bytes, bits);
}

float output_get_float(const unsigned char bytes[4])
{
    uint32_t bits = output_get_u32(bytes);
    float value;
    memcpy(&value, &bits, sizeof value);
    return value;
}

void output_pc2_header(unsigned char header[OUTPUT_PC2_HEADER], uint32_t n_points,
                       uint32_t n_frames)
{
    memcpy(header, "POINTCACHE2", 12);
    output_put_u32(header + 12, 1);
    output_put_u32(header + 16, n_points);
    output_put_float(header + 20, 0.0f); /* start frame */
    output_put_float(header + 24, 1.0f); /* frames a sample, as Blender's exporter has it */
    output_put_u32(header + OUTPUT_PC2_COUNT, n_frames);
}

bool output_pc2_parse(const unsigned char header[OUTPUT_PC2_HEADER], uint32_t *n_points,
                      uint32_t *n_frames)
{
    *n_points = output_get_u32(header + 16);
    *n_frames = output_get_u32(header + OUTPUT_PC2_COUNT);
    return memcmp(header, "POINTCACHE2", 12) == 0 && output_get_u32(header + 12) == 1 &&
           *n_points <= INT32_MAX && *n_frames <= INT32_MAX;
}
