/* The buffer has, one after the other: places, uv, joints, weights, triangles, inverse bind
 * matrices, times and rotations. */
#include "tests/support/skinned.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const double RADIUS = 0.1, MIDDLE = 0.5, BLEND = 0.1; /* m */
enum { PLACES, UVS, JOINTS, WEIGHTS, CORNERS, BINDS, TIMES, TURNS, VIEWS };

uint32_t skinned_vertices(const struct skinned *of)
{
    return of->around * (of->along + 1) + 2;
}

uint32_t skinned_triangles(const struct skinned *of)
{
    return 2 * of->around * (of->along + 1);
}

/* The weight of the upper bone. */
static double weight_at(double y)
{
    return fmin(fmax((y - MIDDLE + BLEND) / (2 * BLEND), 0), 1);
}

void skinned_bend(double time, double x[3])
{
    const double angle = SKINNED_TURN * time, w = weight_at(x[1]), y = x[1] - MIDDLE;
    const double turned[2] = {cos(angle) * x[0] - sin(angle) * y,
                              MIDDLE + sin(angle) * x[0] + cos(angle) * y};
    for (int c = 0; c < 2; c++)
        x[c] += w * (turned[c] - x[c]);
}

/* Those in the file: rings have their first vertex again at their end, then come the two poles. */
static uint32_t n_written(const struct skinned *of)
{
    return (of->around + 1) * (of->along + 1) + 2;
}

static void vertex_at(const struct skinned *of, uint32_t v, double x[3], double uv[2])
{
    const uint32_t ring = of->around + 1, n = n_written(of);
    const bool pole = v + 2 >= n;
    const double j = pole ? (v + 1 == n) * of->along : v / ring, angle = v % ring % of->around;
    uv[0] = pole ? 0 : (double)(v % ring) / of->around;
    uv[1] = j / of->along;
    x[0] = pole ? 0 : RADIUS * cos(2 * M_PI * angle / of->around);
    x[1] = uv[1];
    x[2] = pole ? 0 : RADIUS * sin(2 * M_PI * angle / of->around);
}

static void put_triangle(FILE *file, uint32_t a, uint32_t b, uint32_t c)
{
    const uint32_t corner[3] = {a, b, c};
    fwrite(corner, sizeof corner, 1, file);
}

static void put_triangles(FILE *file, const struct skinned *of)
{
    const uint32_t ring = of->around + 1, low = n_written(of) - 2, high = low + 1;
    for (uint32_t i = 0; i < of->around; i++) {
        put_triangle(file, low, i, i + 1);
        for (uint32_t j = 0; j < of->along; j++) {
            const uint32_t a = j * ring + i;
            put_triangle(file, a, a + ring, a + ring + 1);
            put_triangle(file, a, a + ring + 1, a + 1);
        }
        put_triangle(file, high, of->along * ring + i + 1, of->along * ring + i);
    }
}

static void put_floats(FILE *file, size_t n, const double *value)
{
    for (size_t i = 0; i < n; i++) {
        const float one = (float)value[i];
        fwrite(&one, sizeof one, 1, file);
    }
}

static void put_binds(FILE *file)
{
    for (int bone = 0; bone < 2; bone++) {
        double bind[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
        bind[13] = bone ? -MIDDLE : 0;
        put_floats(file, 16, bind);
    }
}

static void put_keys(FILE *file, const struct skinned *of)
{
    for (uint32_t k = 0; k < of->keys; k++)
        put_floats(file, 1, &(double){(double)k / (of->keys - 1)});
    for (uint32_t k = 0; k < of->keys; k++) {
        const double half = SKINNED_TURN / 2 * k / (of->keys - 1);
        put_floats(file, 4, (double[]){0, 0, sin(half), cos(half)});
    }
}

/* at: where each view begins, and the end. */
static void put_buffer(FILE *file, const struct skinned *of, size_t at[VIEWS + 1])
{
    const uint32_t n = n_written(of);
    for (int view = PLACES; view <= WEIGHTS; view++) {
        at[view] = (size_t)ftell(file);
        for (uint32_t v = 0; v < n; v++) {
            double x[3], uv[2];
            vertex_at(of, v, x, uv);
            const double w = weight_at(x[1]);
            if (view == PLACES)
                put_floats(file, 3, x);
            else if (view == UVS)
                put_floats(file, 2, uv);
            else if (view == JOINTS)
                fwrite((uint8_t[]){0, 1, 0, 0}, 4, 1, file);
            else
                put_floats(file, 4, (double[]){1 - w, w, 0, 0});
        }
    }
    at[CORNERS] = (size_t)ftell(file);
    put_triangles(file, of);
    at[BINDS] = (size_t)ftell(file);
    put_binds(file);
    at[TIMES] = (size_t)ftell(file);
    at[TURNS] = at[TIMES] + of->keys * sizeof(float);
    put_keys(file, of);
    at[VIEWS] = (size_t)ftell(file);
}

static void put_json(FILE *file, const struct skinned *of, const size_t at[VIEWS + 1])
{
    const uint32_t n = n_written(of);
    const struct {
        const char *type;
        int component;
        uint32_t count;
    } accessor[VIEWS] = {{"VEC3", 5126, n},
                         {"VEC2", 5126, n},
                         {"VEC4", 5121, n},
                         {"VEC4", 5126, n},
                         {"SCALAR", 5125, 3 * skinned_triangles(of)},
                         {"MAT4", 5126, 2},
                         {"SCALAR", 5126, of->keys},
                         {"VEC4", 5126, of->keys}};
    const double scale = of->scale > 0 ? of->scale : 1;
    const bool skin = !of->bare && !of->hangs;
    fprintf(
        file,
        "{\"asset\":{\"version\":\"2.0\"},\"scene\":0,\"scenes\":[{\"nodes\":[0]}],\"nodes\":["
        "{\"name\":\"figure\",\"children\":[1,2],\"scale\":[%g,%g,%g]},{\"name\":\"tube\"%s%s},"
        "{\"name\":\"lower\",\"children\":[3]},{\"name\":\"upper\",\"translation\":[0,%g,0]%s}],"
        "\"meshes\":[{\"name\":\"tube\",\"primitives\":[{\"attributes\":{\"POSITION\":0,"
        "\"TEXCOORD_0\":1%s},\"indices\":4}]}],%s",
        scale, scale, scale, of->hangs ? "" : ",\"mesh\":0", skin ? ",\"skin\":0" : "", MIDDLE,
        of->hangs ? ",\"mesh\":0" : "", skin ? ",\"JOINTS_0\":2,\"WEIGHTS_0\":3" : "",
        skin ? "\"skins\":[{\"joints\":[2,3],\"inverseBindMatrices\":5}]," : "");
    fputs("\"animations\":[{\"name\":\"bend\",\"channels\":[{\"sampler\":0,\"target\":{\"node\":3,"
          "\"path\":\"rotation\"}}],\"samplers\":[{\"input\":6,\"output\":7,\"interpolation\":"
          "\"LINEAR\"}]}],\"accessors\":[",
          file);
    for (int i = 0; i < VIEWS; i++)
        fprintf(file, "%s{\"bufferView\":%d,\"componentType\":%d,\"count\":%u,\"type\":\"%s\"}",
                i ? "," : "", i, accessor[i].component, accessor[i].count, accessor[i].type);
    fputs("],\"bufferViews\":[", file);
    for (int i = 0; i < VIEWS; i++)
        fprintf(file, "%s{\"buffer\":0,\"byteOffset\":%zu,\"byteLength\":%zu}", i ? "," : "", at[i],
                at[i + 1] - at[i]);
    fprintf(file, "],\"buffers\":[{\"byteLength\":%zu}]}", at[VIEWS]);
    while (ftell(file) % 4)
        fputc(' ', file);
}

static void put_whole(FILE *file, size_t value)
{
    const uint32_t one = (uint32_t)value;
    fwrite(&one, sizeof one, 1, file);
}

int skinned_write(const struct skinned *of, const char *path)
{
    char *buffer = NULL, *json = NULL;
    size_t n_buffer = 0, n_json = 0, at[VIEWS + 1];
    FILE *to = open_memstream(&buffer, &n_buffer);
    if (!to)
        return 1;
    put_buffer(to, of, at);
    int failed = fclose(to) || !(to = open_memstream(&json, &n_json));
    if (!failed) {
        put_json(to, of, at);
        failed = fclose(to);
    }
    FILE *file = failed ? NULL : fopen(path, "wb");
    if (file) {
        fputs("glTF", file);
        put_whole(file, 2);
        put_whole(file, 28 + n_json + n_buffer);
        put_whole(file, n_json);
        fputs("JSON", file);
        fwrite(json, n_json, 1, file);
        put_whole(file, n_buffer);
        fwrite("BIN", 4, 1, file);
        fwrite(buffer, n_buffer, 1, file);
    }
    failed |= !file || ferror(file);
    failed |= file && fclose(file);
    free(buffer);
    free(json);
    return failed;
}
