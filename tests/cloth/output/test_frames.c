/* A folder of frames, byte by byte where others read it; it is read back, or refused.
 */
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <string.h>
#include <unistd.h>

UNIT_FIXTURE(sample_make, sample_free)

UNIT_TEST(comes_back)
{
    struct output_cache cache;
    double want[3 * SAMPLE_POINTS], got[3 * SAMPLE_POINTS];
    sample_run(1, 3);
    UNIT_FINE(output_cache_open(&cache, sample.frames, &error));
    ck_assert_uint_eq(cache.n_frames, 3);
    ck_assert_uint_eq(cache.mesh.n_vertices, SAMPLE_POINTS);
    ck_assert_uint_eq(cache.mesh.n_faces, sample.mesh[0].n_faces + 1);
    ck_assert_uint_eq(cache.mesh.n_lone_edges, 1);
    ck_assert(cache.fps == 25 && cache.n_obstacles == 2 && cache.n_keys == 2);
    ck_assert_mem_eq(cache.obstacles, sample.setup.obstacles, 2 * sizeof *cache.obstacles);
    ck_assert_mem_eq(cache.keys, sample.setup.keys, 2 * sizeof *cache.keys);
    ck_assert_mem_eq(cache.mesh.position, sample.mesh[0].position, 12 * 3 * sizeof(double));
    for (uint64_t i = 3; i-- > 0;) {
        sample_positions(1, i, want);
        UNIT_FINE(output_cache_frame(&cache, i, got, &error));
        ck_assert_mem_eq(got, want, sizeof want);
        ck_assert(cache.time[i] == (double)i / 25);
    }
    UNIT_REFUSED(output_cache_frame(&cache, 3, got, &error), CLOTH_E_INPUT, "3 frames");
    output_cache_close(&cache);
}

UNIT_TEST(header_is_exact)
{
    static const char WANT[36] = "POINTCACHE2\0"
                                 "\1\0\0\0"
                                 "\20\0\0\0"     /* 16 points */
                                 "\0\0\0\0"      /* from frame 0 */
                                 "\0\0\200\77"   /* 1.0f */
                                 "\2\0\0\0"      /* 2 frames */
                                 "\0\0\372\104"; /* 2000.0f */
    char got[4096];
    sample_run(2, 2);
    size_t n = sample_read(sample_path("cloth.pc2"), got, sizeof got);
    ck_assert_uint_eq(n, 32 + 2 * 12 * SAMPLE_POINTS);
    ck_assert_mem_eq(got, WANT, 36);
}

UNIT_TEST(obj_keeps_faces)
{
    char text[4096];
    sample_run(1, 0);
    sample_read(sample_path("cloth.obj"), text, sizeof text);
    ck_assert_ptr_eq(strstr(text, "o sheet\nv -0.5 0 -0.5\n"), text);
    unit_says(text, "\no a_patch\nv 2 0 0\n");
    unit_says(text, "\nf 13 14 15 16\nl 13 15\n");
    unit_says(text, " 12/12");
    sample_read(sample_path("frames.csv"), text, sizeof text);
    ck_assert_str_eq(text, "frame,time\n");
}

UNIT_TEST(index_tells_time)
{
    char text[256];
    sample_run(1, 3);
    sample_read(sample_path("frames.csv"), text, sizeof text);
    ck_assert_str_eq(text, "frame,time\n0,0\n1,0.040000000000000001\n2,0.080000000000000002\n");
}

UNIT_TEST(replaces_an_earlier_run)
{
    struct output_cache cache;
    sample_run(1, 5);
    sample_run(2, 1);
    UNIT_FINE(output_cache_open(&cache, sample.frames, &error));
    ck_assert_uint_eq(cache.n_frames, 1);
    output_cache_close(&cache);
}

/* The bytes of a frame and its line are there, but the count was not rewritten. */
UNIT_TEST(interrupted_frame_is_ignored)
{
    struct output_cache cache;
    sample_run(1, 2);
    sample_put(sample_path("cloth.pc2"), -1, "half a frame", 12);
    sample_put(sample_path("frames.csv"), -1, "2,0.0", 5);
    UNIT_FINE(output_cache_open(&cache, sample.frames, &error));
    ck_assert_uint_eq(cache.n_frames, 2);
    output_cache_close(&cache);
}

UNIT_TEST(refuses_bad_frames)
{
    struct cloth_error error = {0};
    struct output_frames *frames = NULL;
    double position[3 * SAMPLE_POINTS];
    sample_positions(1, 0, position);
    UNIT_FINE(output_open(&frames, &sample.setup, &error));
    ck_assert_int_eq(output_frame(frames, 1, 0, position, &error), CLOTH_E_RUN);
    error.code = 0;
    position[4] = 1e39; /* no float */
    UNIT_REFUSED(output_frame(frames, 0, 0, position, &error), CLOTH_E_RUN, "vertex 2 ");
    position[4] = 0;
    UNIT_FINE(output_frame(frames, 0, 0, position, &error));
    UNIT_FINE(output_close(&frames, &error));
}

UNIT_TEST(taken_away_while_it_runs)
{
    static const char *const name[] = {"cloth.pc2", "frames.csv"};
    for (int i = 0; i < 3; i++) {
        struct cloth_error error = {0};
        struct output_frames *frames = NULL, *other = NULL;
        double position[3 * SAMPLE_POINTS];
        sample_positions(1, 0, position);
        UNIT_FINE(output_open(&frames, &sample.setup, &error));
        UNIT_FINE(output_frame(frames, 0, 0, position, &error));
        if (i < 2)
            ck_assert_int_eq(unlink(sample_path(name[i])), 0);
        else /* another run */
            UNIT_FINE(output_open(&other, &sample.setup, &error));
        ck_assert_int_eq(output_frame(frames, 1, 0.04, position, &error), CLOTH_E_IO);
        ck_assert_msg(i == 2 || strstr(error.text, sample_path(name[i])), "%s", error.text);
        unit_says(error.text, "was removed or replaced");
        error.code = 0;
        UNIT_FINE(output_close(&frames, &error));
        UNIT_FINE(output_close(&other, &error));
    }
}

UNIT_TEST(makes_parents)
{
    sample.setup.folder = sample_at("a/b/c/");
    sample_run(1, 1);
}

#define MOVES(keys)                                                                                \
    "{\"fps\": 25, \"obstacles\": [{\"sphere\": {\"centre\": [0, 0, 0], \"radius\": 1}, "          \
    "\"about\": "                                                                                  \
    "[0, 0, 0], \"keys\": [" keys "]}]}"

/* A file of a folder, the place in it where other text is put, and what the refusal must say. */
static const struct damage {
    const char *file;
    long at; /* -1: the file becomes the text */
    const char *text, *says;
} DAMAGES[] = {
    {"cloth.pc2", 0, "Q", "not a point cache"},
    {"cloth.pc2", 12, "\2", "not a point cache"},
    {"cloth.pc2", 16, "\21", "17 points"},
    {"cloth.pc2", 28, "\3", "cut off"},
    {"cloth.pc2", -1, "POINTCACHE2", "not a point cache"},
    {"frames.csv", -1, "frame,time\n0,0\n", "frames.csv:3:"},
    {"frames.csv", -1, "frame,time\n0,0\n2,0.04\n", "frames.csv:3:"},
    {"frames.csv", -1, "frame,time\n0,0\n1,nan\n", "frames.csv:3:"},
    {"frames.csv", -1, "frame,times\n0,0\n1,0\n", "frames.csv:1:"},
    {"scene.json", -1, "", "scene.json:1: expected '{'"},
    {"scene.json", -1, "{\"fps\": 25,\n\"planes\": []}",
     "scene.json:2: expected \"obstacles\" in place of \"planes\", which an earlier duite-cloth "
     "wrote: run the scene again"},
    {"scene.json", -1, "{\"fps\": inf, \"obstacles\": []}", "expected a number"},
    {"scene.json", -1, "{\"fps\": 0x10, \"obstacles\": []}", "expected a number"},
    {"scene.json", -1, "{\"fps\": 25, \"obstacles\": []} x", "expected the end"},
    {"scene.json", -1,
     "{\"fps\": 25, \"obstacles\": [{\"plane\": {\"point\": [0, 0, 0], \"normal\": [0, 0, 0]}}]}",
     "a normal that is not zero"},
    {"scene.json", -1,
     "{\"fps\": 25, \"obstacles\": [{\"sphere\": {\"centre\": [0, 0, 0], \"radius\": -1}}]}",
     "a radius above zero"},
    {"scene.json", -1, "{\"fps\": 25, \"obstacles\": [{\"cone\": {}}]}", "a kind of obstacle"},
    {"scene.json", -1, MOVES("{\"time\": 0, \"translate\": [0, 0, 0], \"rotate\": [0, 0, 0, 0]}"),
     "a rotate that is not zero"},
    {"scene.json", -1,
     MOVES("{\"time\": 1, \"translate\": [0, 0, 0], \"rotate\": [1, 0, 0, 0]}, {\"time\": 1, "
           "\"translate\": [0, 0, 0], \"rotate\": [1, 0, 0, 0]}"),
     "times in ascending order"},
    {"cloth.obj", -1, "v 0 0\n", "cloth.obj"},
};

UNIT_LOOP(refuses_damage, 0, sizeof DAMAGES / sizeof *DAMAGES)
{
    const struct damage *damage = &DAMAGES[_i];
    struct output_cache cache;
    sample_run(1, 2);
    const char *path = sample_path(damage->file);
    if (damage->at < 0)
        sample_write(path, damage->text, strlen(damage->text));
    else
        sample_put(path, damage->at, damage->text, strlen(damage->text));
    UNIT_REFUSED(output_cache_open(&cache, sample.frames, &error), CLOTH_E_INPUT, damage->says);
}

UNIT_TEST(refuses_no_folder)
{
    struct output_cache cache;
    UNIT_REFUSED(output_cache_open(&cache, sample.frames, &error), CLOTH_E_INPUT, "No such file");
}
