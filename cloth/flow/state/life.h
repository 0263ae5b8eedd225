#ifndef CLOTH_FLOW_STATE_LIFE_H
#define CLOTH_FLOW_STATE_LIFE_H

#include "cloth/flow/state/fields.h"

/* The words of the last column of fields.h. Pure functions. */
enum flow_life flow_is_state(const struct model *model);
enum flow_life flow_is_derived(const struct model *model);
enum flow_life flow_is_work(const struct model *model);
enum flow_life flow_is_derived_once(const struct model *model);
enum flow_life flow_is_derived_of_bodies(const struct model *model);
enum flow_life flow_is_state_of_ends(const struct model *model);
enum flow_life flow_is_state_of_guess(const struct model *model);
enum flow_life flow_is_state_of_frames(const struct model *model);

#endif
