/* SPDX-License-Identifier: MIT
 * Frames of any kind to a core with all parts, for history_pokes.c.
 */
#ifndef SOAK_POKE_H
#define SOAK_POKE_H

#include "passo_frame.h"
#include "scenario.h"

struct poke {
	enum passo_operation operation;
	uint16_t address;
	uint32_t payload[PASSO_FRAME_PAYLOAD_MAX];
	size_t length;
};

/* Lines or ramps for a while of motion, and values of a raster. */
struct poke poke_lines(struct scenario_random *random);
struct poke poke_ramps(struct scenario_random *random);
struct poke poke_raster(struct scenario_random *random);
/* Any frame; CLEAR half of the time while the channel is `stopped`, as nothing else moves it then. */
struct poke poke_any(struct scenario_random *random, bool stopped);

#endif
