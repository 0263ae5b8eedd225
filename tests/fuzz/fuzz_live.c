/* Messages of the live view, one after the other, as a viewer takes them: each as it is, then with
 * the length and the hash that its bytes should have. */
#include "cloth/live/message.h"
#include "cloth/live/scene.h"
#include "tests/fuzz/fuzz.h"

#include <stdlib.h>
#include <string.h>

enum { KIND_AT = 12 };

static void show(const struct live_message *frame, struct output_cache *cache)
{
    struct cloth_error error = {0};
    double *position = malloc(3 * sizeof *position * cache->mesh.n_vertices);
    if (position && !live_frame_show(frame, cache, &error) &&
        !output_cache_frame(cache, 0, position, &error))
        output_cache_pose(cache, 0, &error);
    free(position);
}

static void take(const uint8_t *bytes, size_t size, struct output_cache *cache)
{
    struct cloth_error error = {0};
    struct live_message message;
    if (live_message_read(bytes, size, &message, &error))
        return;
    if (message.kind == LIVE_SCENE) {
        output_cache_close(cache);
        if (live_scene_open(&message, cache, &error))
            memset(cache, 0, sizeof *cache);
    } else if (message.kind == LIVE_FRAME && cache->held) {
        show(&message, cache);
    }
}

static void take_both(const uint8_t *bytes, size_t size, struct output_cache *cache)
{
    uint8_t *fitting = malloc(size ? size : 1);
    if (!fitting)
        return;
    memcpy(fitting, bytes, size);
    take(fitting, size, cache);
    if (size >= LIVE_HEADER) {
        live_message_seal(fitting, size, (enum live_kind)(fitting[KIND_AT] % (LIVE_END + 1)));
        take(fitting, size, cache);
    }
    free(fitting);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    const size_t mark = strlen(FUZZ_NEXT);
    struct output_cache cache = {0};
    for (const uint8_t *next; (next = memmem(data, size, FUZZ_NEXT, mark));) {
        take_both(data, (size_t)(next - data), &cache);
        size -= (size_t)(next - data) + mark;
        data = next + mark;
    }
    take_both(data, size, &cache);
    output_cache_close(&cache);
    return 0;
}
