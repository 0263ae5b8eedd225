#ifndef DUITE_TOOLS_PREDICT_PLATFORM_H
#define DUITE_TOOLS_PREDICT_PLATFORM_H

#include <stdbool.h>
#include <stdint.h>

/* Hosts and the network between them: a tree, whose leaves are hosts and whose inner places are
 * switches. Plain data; never written once it is made. */

struct predict_place {
    uint32_t up;      /* the switch above; of the top: its own number */
    uint32_t cores;   /* of a host */
    double speed;     /* of a core, times that of the traced run */
    double latency;   /* s, of the link to the switch above */
    double bandwidth; /* bytes/s of that link, in each direction; infinite: enough */
    double capacity;  /* bytes/s of a switch, all messages together; infinite: enough */
};

struct predict_platform {
    struct predict_place *place; /* the hosts, then the switches */
    uint32_t n_hosts, n_places;
};

enum { PREDICT_MOST_SWITCHES = 6 }; /* one above the other */

/* Hosts that are alike on one switch; a message takes the latency. False without memory. */
bool predict_platform_flat(struct predict_platform *platform, uint32_t hosts,
                           const struct predict_place *host, double capacity);

/* Reads the lines of a file:
 *     switch NAME [to SWITCH] [latency S] [bandwidth B] [capacity B]
 *     hosts N to SWITCH [cores N] [speed X] [latency S] [bandwidth B]
 * Words stand apart; # begins a comment. A switch has its line before others name it, and the first
 * one is the top. cores: of hosts that do not say. Errors: DUITE_E_SYSTEM, memory;
 * DUITE_E_ARGUMENT: the message has the line. predict_platform_free is due all the same. */
int predict_platform_read(struct predict_platform *platform, const char *file, uint32_t cores);
void predict_platform_free(struct predict_platform *platform);

/* All cores. */
uint32_t predict_platform_cores(const struct predict_platform *platform);
/* For policies that know one network: the longest latency between two hosts, and the least
 * bandwidth of a host. */
double predict_platform_latency(const struct predict_platform *platform);
double predict_platform_bandwidth(const struct predict_platform *platform);

#endif
