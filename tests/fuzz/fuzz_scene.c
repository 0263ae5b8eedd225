/* Scenes, each of their phases. Beside the scene are the files that it may name: mesh.obj and
 * mesh.seams.json, panels.json, body.obj, and a folder of frames, settled. Lines `#set KEY=VALUE`
 * at its start are given as --set. */
#include "cloth/scene/scene.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>
#include <string.h>

enum { SETS = 4 };

static const char MESH[] = "o cloth1\ng left\nv 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nvt 0 0\nvt 1 0\n"
                           "vt 1 1\nvt 0 1\nf 1/1 2/2 3/3\ng right\nf 1/1 3/3 4/4\n";
static const char SEAMS[] =
    "{\"schema\": 1, \"vertices\": 4, \"triangles\": 2, \"seams\": [{\"sides\": [{\"panel\": "
    "\"a\", \"edge\": 0}, {\"panel\": \"a\", \"edge\": 1}], \"pairs\": [[0, 1], [3, 2]]}]}";
static const char PANELS[] =
    "{\"pattern\": {\"panels\": {\"a\": {\"vertices\": [[0, 0], [0, 1], [1, 1], [1, 0]], "
    "\"edges\": [{\"endpoints\": [0, 1]}, {\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]}, "
    "{\"endpoints\": [3, 0]}], \"translation\": [0, 0, 0], \"rotation\": [0, 0, 0]}, \"b\": "
    "{\"vertices\": [[0, 0], [0, 1], [1, 1], [1, 0]], \"edges\": [{\"endpoints\": [0, 1]}, "
    "{\"endpoints\": [1, 2]}, {\"endpoints\": [2, 3]}, {\"endpoints\": [3, 0]}], \"translation\": "
    "[0, 0, 1], \"rotation\": [0, 0, 0]}}, \"stitches\": [[{\"panel\": \"a\", \"edge\": 0}, "
    "{\"panel\": \"b\", \"edge\": 0}]]}, \"properties\": {\"units_in_meter\": 1}}";
static const char BODY[] =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
static const char FRAME[32 + 48] = "POINTCACHE2\0\1\0\0\0\4\0\0\0\0\0\0\0\0\0\200\77\1";

static void write_others(void)
{
    fuzz_file("mesh.obj", MESH, sizeof MESH - 1);
    fuzz_file("mesh.seams.json", SEAMS, sizeof SEAMS - 1);
    fuzz_file("panels.json", PANELS, sizeof PANELS - 1);
    fuzz_file("body.obj", BODY, sizeof BODY - 1);
    fuzz_file("settled/cloth.obj", MESH, sizeof MESH - 1);
    fuzz_file("settled/cloth.pc2", FRAME, sizeof FRAME);
}

/* The sets at the start of a text, which is changed. */
static size_t take_sets(char *text, struct scene_set set[SETS])
{
    size_t n = 0;
    for (char *end; n < SETS && strncmp(text, "#set ", 5) == 0 && (end = strchr(text, '\n'));
         text = end + 1) {
        *end = '\0';
        set[n++] = (struct scene_set){.text = text + 5};
    }
    return n;
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static int begun;
    struct scene_set set[SETS];
    char *text = malloc(size + 1);
    if (!text)
        return 0;
    if (!begun++)
        write_others();
    memcpy(text, data, size);
    text[size] = '\0';
    const size_t n = take_sets(text, set);
    const char *path = fuzz_file("scene.yaml", data, size);
    struct cloth_error error = {0};
    struct model *models;
    uint32_t n_models;
    scene_read_phases(&models, &n_models, path, n, set, &error);
    for (uint32_t i = 0; i < n_models; i++)
        model_free(models + i);
    free(models);
    free(text);
    return 0;
}
