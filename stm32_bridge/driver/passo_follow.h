/* SPDX-License-Identifier: MIT
 * Follows timed points (c_model/planner/passo_timed.h): a motion in which all axes are at given places at
 * given times.
 *
 *     static struct passo_follow follow;
 *
 *     if (passo_follow(&passo, &follow, &settings, points, count) == PASSO_ERROR_SUPPLY)
 *             ... follow.refused is the number of the first point that cannot be made, follow.reason why
 *     while (passo_is_moving(&passo))
 *             passo_poll(&passo);
 * The core has half of its line queue as a reserve: if the program comes late, the axes decelerate along the
 * points that the core knows, within the stop time of passo_configure_motion() (RAMP_UNDERRUN).
 */
#ifndef PASSO_FOLLOW_H
#define PASSO_FOLLOW_H

#include "passo.h"
#include "passo_timed.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Members other than those after an error are private. */
struct passo_follow {
	struct passo_timed timed;
	const struct passo_timed_point *points;
	uint32_t count, given; /* points, and lines handed out */
	uint32_t reserve;      /* lines that the ramps stay behind */
	uint32_t covered;      /* lines that the ramps reach */
	uint64_t ticks;        /* of the ramps */
	bool jumped;           /* to the velocity */
	/* after PASSO_ERROR_SUPPLY of passo_follow() */
	uint32_t refused;              /* number of the point, from 0; `count`: the rest after the last one */
	uint8_t axis;                  /* of settings; `axes` and above: a motor */
	enum passo_timed_error reason; /* passo_timed_error_text() */
};

/* Checks all points, against the settings and the pin timing, then fills the queue and starts the motion,
 * from rest at passo_target(). `settings`, `points` and `follow` must stay valid until its end. As many
 * frames as the queue takes. Errors: those of passo_stream(), passo_poll() and passo_target(); SUPPLY: a
 * point was refused, and nothing moves; NOT_CONFIGURED; ARGUMENT_AXIS for more motors than the channel has.
 */
enum passo_error passo_follow(struct passo *passo, struct passo_follow *follow,
    const struct passo_path_settings *settings, const struct passo_timed_point *points, uint32_t count);

#ifdef __cplusplus
}
#endif

#endif
