/* The live view of a build without ZeroMQ: each function says why there is none. */
#include "cloth/live/live.h"

const char *live_lacks(void)
{
    return "this duite was built without ZeroMQ; install libzmq3-dev (./bootstrap does), then "
           "build again";
}

int live_publish_open(struct live_publisher **publisher, const char *address,
                      void (*warn)(const char *text), struct cloth_error *error)
{
    (void)warn;
    *publisher = NULL;
    return cloth_fail(error, CLOTH_E_INPUT, "--live %s: %s", address, live_lacks());
}
/* No publisher is ever open, so the rest is never reached. */
const char *live_publish_address(const struct live_publisher *publisher)
{
    (void)publisher;
    return "";
}
int live_publish_scene(struct live_publisher *publisher, const struct output_setup *setup,
                       double begin, struct cloth_error *error)
{
    (void)publisher, (void)setup, (void)begin, (void)error;
    return 0;
}
void live_publish_frame(struct live_publisher *publisher, uint64_t frame, double time,
                        const double *position)
{
    (void)publisher, (void)frame, (void)time, (void)position;
}
void live_publish_close(struct live_publisher **publisher)
{
    *publisher = NULL;
}

int live_follow_open(struct live_follower **follower, const char *host, struct cloth_error *error)
{
    *follower = NULL;
    return cloth_fail(error, CLOTH_E_INPUT, "--connect %s: %s", host, live_lacks());
}
int live_follow(struct live_follower *follower, double seconds, enum live_news *news,
                struct cloth_error *error)
{
    (void)follower, (void)seconds;
    *news = LIVE_NOTHING;
    return cloth_fail(error, CLOTH_E_LIBRARY, "%s", live_lacks());
}
struct output_cache *live_follow_cache(struct live_follower *follower)
{
    (void)follower;
    return NULL;
}
const char *live_follow_state(struct live_follower *follower, bool *waits)
{
    (void)follower;
    *waits = true;
    return live_lacks();
}
uint64_t live_follow_frame(const struct live_follower *follower)
{
    (void)follower;
    return 0;
}
void live_follow_close(struct live_follower **follower)
{
    *follower = NULL;
}
