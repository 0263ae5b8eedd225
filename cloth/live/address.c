/* Numbers alone: no name is looked up before a run. */
#include "cloth/live/live.h"

#include <stdlib.h>
#include <string.h>

static bool is_port(const char *text, unsigned long least)
{
    char *end = NULL;
    const unsigned long port = strtoul(text, &end, 10);
    return *text >= '0' && *text <= '9' && !*end && port >= least && port <= 65535;
}

bool live_is_address(const char *text)
{
    const char *colon = strrchr(text, ':');
    return is_port(colon ? colon + 1 : text, 0) && colon != text;
}

bool live_is_host(const char *text)
{
    const char *colon = strrchr(text, ':');
    return colon && colon != text && is_port(colon + 1, 1);
}
