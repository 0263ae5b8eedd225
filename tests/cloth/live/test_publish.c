/* A run and its viewers in one process: who gets what, and when. */
#include "cloth/live/live.h"
#include "cloth/live/message.h"
#include "tests/cloth/output/sample.h"
#include "tests/support/unit.h"

#include <string.h>
#include <zmq.h>

static struct live_publisher *publisher;
static struct live_follower *follower;
static int warnings;

static void warn(const char *text)
{
    (void)text;
    warnings++;
}

static void open_run(const char *address)
{
    UNIT_FINE(live_publish_open(&publisher, address, warn, &error));
    UNIT_FINE(live_publish_scene(publisher, &sample.setup, 0, &error));
}

static void start(void)
{
    sample_make();
    open_run("0");
    UNIT_FINE(live_follow_open(&follower, live_publish_address(publisher), &error));
}

static void end(void)
{
    live_publish_close(&publisher);
    live_follow_close(&follower);
    sample_free();
}

static void publish(uint64_t frame)
{
    double x[3 * SAMPLE_POINTS];
    sample_positions(1, frame, x);
    live_publish_frame(publisher, frame, 0.04 * (double)frame, x);
}

/* The follower gets that news, or, of LIVE_NOTHING, none. */
static void expect(enum live_news wanted, uint64_t frame)
{
    double x[3 * SAMPLE_POINTS];
    enum live_news news;
    UNIT_FINE(live_follow(follower, wanted ? 60 : 0.2, &news, &error));
    ck_assert_int_eq(news, wanted);
    if (wanted == LIVE_NOTHING)
        return;
    sample_positions(1, frame, x);
    const struct output_cache *cache = live_follow_cache(follower);
    ck_assert_mem_eq(cache->held, x, sizeof x);
    ck_assert_double_eq(cache->time[0], 0.04 * (double)frame);
    ck_assert_uint_eq(live_follow_frame(follower), frame);
}

/* It comes to stand so, without news. */
static void expect_state(const char *wanted, bool waiting)
{
    enum live_news news;
    bool waits;
    const char *state = live_follow_state(follower, &waits);
    for (int i = 0; i < 600 && strncmp(state, wanted, strlen(wanted)) != 0; i++) {
        UNIT_FINE(live_follow(follower, 0.1, &news, &error));
        ck_assert_int_eq(news, LIVE_NOTHING);
        state = live_follow_state(follower, &waits);
    }
    ck_assert_msg(!strncmp(state, wanted, strlen(wanted)), "%s, not %s", state, wanted);
    ck_assert_int_eq(waits, waiting);
}

UNIT_FIXTURE(start, end)

UNIT_TEST(the_newest_frame)
{
    expect_state("waits for a run at 127.0.0.1:", true);
    expect_state("connected to 127.0.0.1:", true);
    publish(0);
    expect(LIVE_NEW_SCENE, 0);
    publish(1);
    publish(2);
    publish(3);
    expect(LIVE_NEW_FRAME, 3);
    expect(LIVE_NOTHING, 0);
    expect_state("frame 3, 0.12 s, live from ", false);
}

UNIT_TEST(another_scene_of_the_run)
{
    publish(0);
    expect(LIVE_NEW_SCENE, 0);
    expect(LIVE_NOTHING, 0);
    sample.setup.n_obstacles = 1;
    UNIT_FINE(live_publish_scene(publisher, &sample.setup, 0, &error));
    publish(1);
    expect(LIVE_NEW_SCENE, 1);
    ck_assert_uint_eq(live_follow_cache(follower)->n_obstacles, 1);
}

UNIT_TEST(the_end_and_another_run)
{
    char address[100];
    publish(7);
    expect(LIVE_NEW_SCENE, 7);
    snprintf(address, sizeof address, "%s", live_publish_address(publisher));
    live_publish_close(&publisher);
    expect_state("the run has ended at frame 7; waits for the next one at 127.0.0.1:", true);
    open_run(address);
    publish(2);
    expect(LIVE_NEW_SCENE, 2);
}

/* Frames of a slow run come more than 2 s apart, and a viewer waits for each as long. */
UNIT_TEST(the_last_frame_of_a_slow_run)
{
    publish(0);
    expect(LIVE_NEW_SCENE, 0);
    for (int i = 0; i < 12; i++)
        expect(LIVE_NOTHING, 0);
    publish(1);
    live_publish_close(&publisher);
    expect(LIVE_NEW_FRAME, 1);
    expect_state("the run has ended at frame 1; ", true);
}

UNIT_TEST(a_frame_that_is_not_finite)
{
    double x[3 * SAMPLE_POINTS];
    sample_positions(1, 1, x);
    publish(0);
    x[4] = 1e300;
    live_publish_frame(publisher, 1, 0.04, x);
    expect(LIVE_NEW_SCENE, 0);
    expect(LIVE_NOTHING, 0);
}

UNIT_TEST(an_address_that_is_taken)
{
    struct live_publisher *other;
    UNIT_REFUSED(live_publish_open(&other, live_publish_address(publisher), warn, &error),
                 CLOTH_E_INPUT, "the port is in use");
    ck_assert_ptr_null(other);
}

/* Any program can ask by a REQ socket, whose messages begin with an empty part. */
UNIT_TEST(a_viewer_of_another_kind)
{
    static unsigned char bytes[10000];
    char endpoint[120];
    const int patience = 60000;
    void *zmq = zmq_ctx_new(), *socket = zmq_socket(zmq, ZMQ_REQ);
    struct live_message message = {.kind = LIVE_REQUEST};
    snprintf(endpoint, sizeof endpoint, "tcp://%s", live_publish_address(publisher));
    ck_assert_int_eq(zmq_setsockopt(socket, ZMQ_RCVTIMEO, &patience, sizeof patience), 0);
    ck_assert_int_eq(zmq_connect(socket, endpoint), 0);
    publish(5);
    for (int i = 0; i < 2; i++) {
        message.kind = LIVE_REQUEST;
        ck_assert_int_gt(zmq_send(socket, bytes, live_message_write(bytes, &message), 0), 0);
        const int n = zmq_recv(socket, bytes, sizeof bytes, 0);
        ck_assert_int_gt(n, 0);
        UNIT_FINE(live_message_read(bytes, (size_t)n, &message, &error));
        ck_assert_int_eq(message.kind, i ? LIVE_FRAME : LIVE_SCENE);
        message.number = 0;
    }
    zmq_close(socket);
    zmq_ctx_term(zmq);
    ck_assert_int_eq(warnings, 0);
}
