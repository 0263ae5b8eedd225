/* Blocks, ranks and shapes are read again for the frames that they count from, whatever becomes of
 * the run. A damaged file is refused. */
#include "cloth/output/colours.h"
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { N = 5, BLOCKS = 2 };
static const int32_t BLOCK[N] = {0, 1, -1, 1, 0};

static struct output_colours *writer;
static struct output_colours_read *reader;
static struct cloth_error error;

static const char *path(void)
{
    return sample_at("colours.bin");
}

static void end(void)
{
    output_colours_unload(reader);
    sample_free();
}

static void begins(const uint64_t *n_frames)
{
    UNIT_FINE(output_colours_open(&writer, sample.folder, N, n_frames, &error));
}

static void ends(void)
{
    UNIT_FINE(output_colours_close(&writer, &error));
    ck_assert_ptr_null(writer);
}

static void places(uint64_t frame, int32_t first, int32_t second)
{
    const int32_t rank[BLOCKS] = {first, second};
    UNIT_FINE(output_colours_places(writer, frame, BLOCK, BLOCKS, rank, &error));
}

static long size_of(void)
{
    return (long)sample_stat(path()).st_size;
}

static void opens(void)
{
    output_colours_unload(reader);
    UNIT_FINE(output_colours_load(&reader, sample.folder, N, &error));
}

static void has_ranks(uint64_t frame, int32_t first, int32_t second)
{
    int32_t rank[N];
    const int32_t expected[N] = {first, second, -1, second, first};
    UNIT_FINE(output_colours_ranks(reader, frame, rank, &error));
    ck_assert_mem_eq(rank, expected, sizeof rank);
}

UNIT_FIXTURE(sample_make, end)

UNIT_TEST(places_are_read_again)
{
    int32_t block[N];
    begins(NULL);
    places(0, 0, 3);
    ends();
    opens();
    UNIT_FINE(output_colours_blocks(reader, 7, block, &error));
    ck_assert_mem_eq(block, BLOCK, sizeof block);
    has_ranks(0, 0, 3);
    has_ranks(7, 0, 3);
}

UNIT_TEST(only_what_changes_is_written_again)
{
    begins(NULL);
    places(0, 0, 1);
    const long size = size_of();
    places(1, 0, 1);
    ck_assert_int_eq(size_of(), size);
    places(2, 1, 1);
    ck_assert_int_eq(size_of(), size + 16 + 4 * BLOCKS);
    ends();
    opens();
    has_ranks(1, 0, 1);
    has_ranks(2, 1, 1);
    has_ranks(1, 0, 1);
}

UNIT_TEST(a_run_that_goes_on_keeps_what_came_before)
{
    const uint64_t two = 2;
    begins(NULL);
    places(0, 0, 1);
    places(2, 1, 0);
    ends();
    begins(&two);
    places(2, 2, 2);
    ends();
    opens();
    has_ranks(1, 0, 1);
    has_ranks(2, 2, 2);
    begins(NULL);
    ends();
    ck_assert_int_eq(size_of(), 16);
}

UNIT_TEST(what_is_not_whole_was_not_written)
{
    begins(NULL);
    places(0, 0, 1);
    const long size = size_of();
    places(1, 1, 0);
    ends();
    for (long cut = size_of() - 1; cut >= size; cut--) {
        ck_assert_int_eq(truncate(path(), cut), 0);
        opens();
        has_ranks(1, 0, 1);
    }
    ck_assert_int_eq(truncate(path(), 16), 0);
    opens();
    int32_t block[N];
    UNIT_REFUSED(output_colours_blocks(reader, 0, block, &error), CLOTH_E_INPUT,
                 "does not say the blocks of frame 0");
}

/* A triangle, an edge, two materials. */
static void fill(struct element_strains *rest)
{
    *rest = (struct element_strains){.n_triangles = 1, .n_edges = 1, .n_materials = 2};
    UNIT_FINE(element_strains_room(rest, &error));
    memcpy(rest->corner[0], (uint32_t[]){2, 0, 4, 1}, sizeof *rest->corner);
    rest->gradient[0] = (phys_vec){1, -2, 0.5, 4};
    rest->area[0] = 0.125;
    memcpy(rest->edge[0], (uint32_t[]){1, 3}, sizeof *rest->edge);
    rest->length[0] = 0.75;
    rest->membrane[1].modulus = (phys_vec){1000, 300, 900, 50};
    rest->has_stress[1] = true;
}

static void write_rest(uint64_t frame)
{
    UNIT_OWNED(element_strains_free) struct element_strains rest;
    fill(&rest);
    UNIT_FINE(output_colours_rest(writer, frame, &rest, &error));
}

UNIT_TEST(the_size_is_known_before)
{
    UNIT_OWNED(element_strains_free) struct element_strains rest;
    begins(NULL);
    write_rest(0);
    places(0, 0, 1);
    ends();
    fill(&rest);
    ck_assert_int_eq(size_of(), (long)output_colours_bytes(N, BLOCKS, &rest));
}

UNIT_TEST(shapes_are_read_again)
{
    UNIT_OWNED(element_strains_free) struct element_strains rest, read;
    begins(NULL);
    write_rest(0);
    write_rest(3);
    ends();
    opens();
    fill(&rest);
    ck_assert_uint_eq(output_colours_rest_since(reader, 2), 0);
    ck_assert_uint_eq(output_colours_rest_since(reader, 9), 3);
    UNIT_FINE(output_colours_rest_at(reader, 2, &read, &error));
    ck_assert_uint_eq(read.n_triangles, 1);
    ck_assert_mem_eq(read.corner, rest.corner, sizeof *rest.corner);
    ck_assert_mem_eq(read.gradient, rest.gradient, sizeof *rest.gradient);
    ck_assert_double_eq(read.area[0], rest.area[0]);
    ck_assert_mem_eq(read.edge, rest.edge, sizeof *rest.edge);
    ck_assert_double_eq(read.length[0], rest.length[0]);
    ck_assert_mem_eq(read.membrane, rest.membrane, 2 * sizeof *rest.membrane);
    ck_assert(!read.has_stress[0] && read.has_stress[1]);
}

/* Any byte may be any other: what is read then is in range, or refused. */
UNIT_TEST(damage_does_no_harm)
{
    begins(NULL);
    places(0, 0, 1);
    write_rest(0);
    ends();
    char bytes[1024];
    const long size = (long)sample_read(path(), bytes, sizeof bytes);
    ck_assert_int_lt(size, (long)sizeof bytes - 1);
    for (long at = 16; at < size; at++)
        for (int value = 0; value < 256; value += 51) {
            int32_t number[N];
            struct element_strains rest = {0};
            sample_put(path(), at, (char[]){(char)value}, 1);
            output_colours_unload(reader);
            if (!output_colours_load(&reader, sample.folder, N, &error)) {
                if (!output_colours_ranks(reader, 0, number, &error))
                    for (int v = 0; v < N; v++)
                        ck_assert(number[v] >= -1 && number[v] < N);
                if (!output_colours_rest_at(reader, 0, &rest, &error))
                    for (uint32_t t = 0; t < rest.n_triangles; t++)
                        ck_assert(rest.corner[t][0] < N && rest.corner[t][3] < rest.n_materials &&
                                  isfinite(rest.area[t]));
                element_strains_free(&rest);
            }
            sample_put(path(), at, bytes + at, 1);
        }
    sample_put(path(), 0, "d", 1);
    output_colours_unload(reader);
    ck_assert_int_eq(output_colours_load(&reader, sample.folder, N, &error), CLOTH_E_INPUT);
    sample_put(path(), 0, "D", 1);
    output_colours_unload(reader);
    UNIT_REFUSED(output_colours_load(&reader, sample.folder, N + 1, &error), CLOTH_E_INPUT,
                 "of another mesh than cloth.obj");
}

UNIT_TEST(a_file_of_somebody_else_stays)
{
    sample_write(path(), "mine\n", 5);
    UNIT_REFUSED(output_colours_open(&writer, sample.folder, N, NULL, &error), CLOTH_E_INPUT,
                 "colours.bin is in the way");
    output_colours_close(&writer, &error);
    ck_assert_int_eq(size_of(), 5);
}

UNIT_TEST(without_a_file_it_says_who_writes_it)
{
    UNIT_REFUSED(output_colours_load(&reader, sample.folder, N, &error), CLOTH_E_INPUT,
                 "duite-cloth --output writes it");
}
