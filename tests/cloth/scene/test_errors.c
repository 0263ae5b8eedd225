/* Errors of scenes that sentences.txt cannot hold: of files that are not there, of other options
 * than
 * --set, of what the machine has no room for. */
#include "tests/cloth/scene/scene_file.h"
#include "tests/support/unit.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

UNIT_TEST(files_that_cannot_be_read)
{
    UNIT_OWNED(model_free) struct model model;
    static const char *const cases[][2] = {
        {"/nowhere/x.yaml",
         "/nowhere/x.yaml: cannot open the scene file: No such file or directory"},
        {"/tmp", "/tmp: cannot read the scene file: Is a directory"}};
    for (int i = 0; i < 2; i++) {
        UNIT_CALL(scene_read(&model, cases[i][0], 0, NULL, &error),
                  ck_assert_int_eq(unit_code, CLOTH_E_INPUT);
                  ck_assert_str_eq(error.text, cases[i][1]));
        model_free(&model);
    }
    ck_assert_int_eq(scene_read(&model, "/tmp", 0, NULL, NULL), CLOTH_E_INPUT);
}

UNIT_TEST(sets_of_other_options)
{
    UNIT_OWNED(model_free) struct model model;
    const struct scene_set sets[] = {{"time.h=1e-3", NULL}, {"grain=0", "--grain 0"}};
    UNIT_CALL(
        scene_read_text(&model, scene_right, 2, sets, &error),
        ck_assert_int_eq(unit_code, CLOTH_E_INPUT);
        ck_assert_str_eq(error.text,
                         "--grain 0: grain is 0; a whole number from 1 to 4294967295 is expected"));
    model_free(&model);
    const struct scene_set open[] = {{"time.end=[", "--end ["}};
    UNIT_CALL(scene_read_text(&model, scene_right, 1, open, &error),
              ck_assert_int_eq(unit_code, CLOTH_E_INPUT);
              ck_assert_ptr_eq(strstr(error.text, "--end [: the value is not YAML: "), error.text));
}

static void expect_error(const char *from, const char *to, const char *expected)
{
    UNIT_OWNED(model_free) struct model model;
    char *text = scene_changed(scene_right, from, to);
    UNIT_REFUSED(scene_read_text(&model, text, 0, NULL, &error), CLOTH_E_INPUT, expected);
    free(text);
}

UNIT_TEST(grids_larger_than_the_machine)
{
    const double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (memory > 4.8e10)
        return;
    char error[200];
    snprintf(error, sizeof error,
             ":5:44: nx times ny is 324000000 vertices, which take 49 GB of memory or more; this "
             "machine has %.0f GB",
             memory / 1e9);
    expect_error("nx: 4, ny: 3", "nx: 18000, ny: 18000", error);
}

UNIT_TEST(more_panels_than_there_is_room_for)
{
    static const char fan[] = "v 0 0 0\nv 1 0 0\nv 1 0 1\nvt 0 0\nvt 1 0\nvt 1 1\n"
                              "g left\nf 1/1 3/3 2/2\n";
    char mesh[4100] = "mesh: {file: fan.obj}\n    panels: [{group: left, grain: 1}";
    for (int i = 0; i < 64; i++)
        strcat(mesh, ", {group: left, material: cotton}");
    strcat(mesh, "]");
    scene_write_file("fan.obj", fan, sizeof fan - 1);
    expect_error("mesh: {grid: {width: 1, height: 2, nx: 4, ny: 3}}", mesh,
                 ":6:13: cloth 'sheet' has 65 panels and regions; at most 64 are possible");
}

/* Scenes that are made to take all memory, or all time. */
UNIT_TEST(scenes_without_end)
{
    static const struct {
        const char *head, *more, *tail;
        int n;
        const char *expected;
    } cases[] = {
        {"schema: 1\na: ", "[", "", 100000,
         ":2: more than 1000 brackets [ and { are open here; a scene needs a few"},
        {"schema: 1\nphases:\n  - name: one\n    set:\n      ? ", "a.", "b\n      : 1", 200000,
         ":5:9: phases[0].set: a key of more than 100 parts; no scene is as deep"},
        {"schema: 1\n", "k%d: 1\n", "", 4096,
         ":1:1: a map of 4097 keys; a scene has at most 4096 in one map"},
        {"schema: 1\na:\n", "  - &a%d 1\n", "", 1001,
         ":1003: more than 1000 anchors, such as &name, are in the file; a scene needs a few"},
        {"schema: 1\nprobes:\n  - &p {vertices: [0]}\n", "  - *p\n", "", 200000,
         ":3:3: probes is a list of 200001; a list of at most 4096 maps is expected"},
        {"schema: 1\nphases:\n", "  - {name: p%d}\n", "", 1000,
         ":3:3: phases is a list of 1000; a list of 1 to 100 maps is expected"}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        UNIT_OWNED(model_free) struct model model;
        char *text = NULL;
        size_t size;
        FILE *to = open_memstream(&text, &size);
        ck_assert_ptr_nonnull(to);
        fputs(cases[i].head, to);
        for (int k = 0; k < cases[i].n; k++)
            fprintf(to, cases[i].more, k);
        fputs(cases[i].tail, to);
        ck_assert_int_eq(fclose(to), 0);
        UNIT_REFUSED(scene_read_text(&model, text, 0, NULL, &error), CLOTH_E_INPUT,
                     cases[i].expected);
        free(text);
    }
}
