/* SPDX-License-Identifier: MIT
 * Internal: shared by the planning methods. See passo_plan.c for the steps from a draft to a plan.
 */
#ifndef PASSO_PLAN_DRAFT_H
#define PASSO_PLAN_DRAFT_H

#include "passo_math.h"
#include "passo_plan.h"

/* A weight is a number of ticks in units of 2^-24. */
#define PASSO_WEIGHT_BITS 24u

/* Mean of every symmetric shape, in units of 2^-24. */
#define PASSO_MEAN_HALF (UINT32_C(1) << 23)

/* No speed limit, for passo_draft_in_ticks(). */
#define PASSO_ANY_SPEED UINT64_MAX

/* A ramp is given by its acceleration (UQ32.32 steps/s^2) or, if that is 0, by the time of a full ramp
 * between the start or stop speed and the speed. A jerk (UQ32.32 steps/s^3) limits the change of
 * acceleration; it requires an acceleration and a draft with profile jerk. */
struct passo_rise {
	uint64_t acceleration, ramp_clocks, jerk;
};

/* Limits of a move by speed; speeds are UQ32.32 steps/s. */
struct passo_limits {
	uint64_t start_speed, speed, stop_speed;
	struct passo_rise up, down;
};

/* Length of a ramp, with 64 bits to detect overflow. */
struct passo_phase {
	uint64_t ticks;
	uint64_t straight; /* ticks of constant acceleration between the two curves of a jerk-limited ramp */
	uint64_t weight;   /* weight of the ramp's end velocity in its distance */
};

/* A move while it is being planned. */
struct passo_draft {
	const struct passo_machine *machine;
	const int32_t *steps;
	enum passo_profile profile;
	enum passo_shape shape; /* of the ramps */
	uint32_t sigmoid_alpha; /* alpha of a sigmoid in units of 1/4096; 0: no sigmoid */
	const uint16_t *table;  /* points of a user-defined shape, else null */
	bool mirrors;           /* deceleration mirrors it */
	uint32_t mean;          /* mean of the shape in units of 2^-24; 1/2 except for some tables */
	uint64_t (*table_weight)(const struct passo_draft *draft, uint64_t ticks, bool mirror);
	uint32_t longest;      /* steps of the longest axis */
	uint32_t oversampling; /* K: substeps per step of the longest axis */
	struct passo_phase accelerate, decelerate;
	uint64_t cruise;            /* ticks */
	uint64_t start, peak, stop; /* UQ0.48 substeps per clock */
};

/* Checks machine, steps and profile, and initializes a draft. */
enum passo_plan_error passo_draft_start(struct passo_draft *draft, const struct passo_machine *machine,
    const int32_t *steps, enum passo_profile profile);

/* Each turns a draft into a plan, which is written only on success.
 *
 * In time: as passo_plan_in_time().
 * In ticks: in `total` ticks, of which each ramp takes `ramp`, at most half. The peak is clamped to
 * speed_limit (UQ32.32 steps/s), which only rounding may exceed. By speed: the fastest move within the
 * limits; as passo_plan_by_speed(). */
enum passo_plan_error passo_draft_in_time(
    struct passo_draft *draft, uint64_t total_clocks, uint64_t ramp_clocks, struct passo_plan *plan);
enum passo_plan_error passo_draft_in_ticks(
    struct passo_draft *draft, uint64_t total, uint64_t ramp, uint64_t speed_limit, struct passo_plan *plan);
enum passo_plan_error passo_draft_by_speed(
    struct passo_draft *draft, const struct passo_limits *limits, struct passo_plan *plan);

/* The stages of planning, in this order; passo_draft_weigh() comes before weight and distance.
 * passo_draft_halvable() rounds the ticks of a jerk-limited ramp up to an even number. passo_draft_distance()
 * is the distance that the peak has to cover, in units of velocity times weight. */
bool passo_draft_is_too_long(const struct passo_draft *draft);
uint64_t passo_draft_halvable(const struct passo_draft *draft, uint64_t ticks);
void passo_draft_weigh(struct passo_draft *draft);
void passo_draft_oversample_to(struct passo_draft *draft, uint64_t fit);
uint64_t passo_draft_weight(const struct passo_draft *draft);
struct passo_u128 passo_draft_distance(const struct passo_draft *draft);
void passo_draft_solve(struct passo_draft *draft);
void passo_draft_finish(const struct passo_draft *draft, struct passo_plan *plan);
uint64_t passo_oversampling_at(const struct passo_machine *machine, uint64_t speed);

/* The limits in the parameters of a move by speed. */
struct passo_limits passo_limits_of(const struct passo_move_by_speed *move);

/* Sets the oversampling to the highest value that this speed of the longest axis allows, and returns it; 0:
 * too fast. */
uint32_t passo_draft_oversample(struct passo_draft *draft, uint64_t speed);

/* Converts a speed (UQ32.32 steps/s) to a velocity (UQ0.48 substeps per clock), rounded down. */
uint64_t passo_draft_velocity(const struct passo_draft *draft, uint64_t speed);

/* Appends a ramp to a plan. */
void passo_plan_add_ramp(
    struct passo_plan *plan, enum passo_shape shape, bool mirror, uint64_t velocity_end, uint64_t ticks);

/* Weight that a ramp of a symmetric shape lacks because its progress does not end at exactly 1: ticks^2 * (1
 * - end) / divisor, with divisor = 2 * ticks for a single ramp. Can be negative. */
int64_t passo_lacking_weight(uint64_t ticks, uint64_t divisor);

/* Clocks to ticks, rounded to nearest or up. */
uint64_t passo_ticks_nearest(const struct passo_machine *machine, uint64_t clocks);
uint64_t passo_ticks_ceil(const struct passo_machine *machine, uint64_t clocks);

static inline uint32_t passo_magnitude(int32_t steps)
{
	return steps < 0 ? 0u - (uint32_t)steps : (uint32_t)steps;
}

static inline uint64_t passo_smaller(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

#endif
