/* SPDX-License-Identifier: MIT
 * What the planning methods share; not for the planner's users. passo_plan.c tells how a draft becomes a
 * plan.
 */
#ifndef PASSO_PLAN_DRAFT_H
#define PASSO_PLAN_DRAFT_H

#include "passo_math.h"
#include "passo_plan.h"

/* Weights are ticks in units of 2^-24. */
#define PASSO_WEIGHT_BITS 24u

/* Mean of every symmetric shape, in units of 2^-24. */
#define PASSO_MEAN_HALF (UINT32_C(1) << 23)

/* For passo_draft_in_ticks(): above all that a plan can reach. */
#define PASSO_ANY_SPEED UINT64_MAX

/* How a ramp changes the speed: by an acceleration (UQ32.32 steps/s^2) or, where that is 0, between rest or
 * the end's speed and the full speed in a given time. A jerk (UQ32.32 steps/s^3) limits how the acceleration
 * changes; it needs an acceleration, and a draft of the profile jerk. */
struct passo_rise {
	uint64_t acceleration, ramp_clocks, jerk;
};

/* What a move by speeds (UQ32.32 steps/s) keeps to. */
struct passo_limits {
	uint64_t start_speed, speed, stop_speed;
	struct passo_rise up, down;
};

/* A ramp's ticks; 64 bits to notice what is too long. */
struct passo_phase {
	uint64_t ticks;
	uint64_t straight; /* of them, between the two curved ends of a jerk-limited ramp */
	uint64_t weight;   /* how much of them the distance owes to the velocity that the ramp leads to */
};

/* A move on its way to a plan. */
struct passo_draft {
	const struct passo_machine *machine;
	const int32_t *steps;
	enum passo_profile profile;
	enum passo_shape shape; /* of the ramps */
	uint32_t sigmoid_alpha; /* its alpha in 1/4096, if it is a sigmoid */
	const uint16_t *table;  /* its points, if the user gives them; then slowing down mirrors it */
	uint32_t mean;          /* its mean in units of 2^-24: in the middle, but for some tables */
	uint64_t (*table_weight)(const struct passo_draft *draft, uint64_t ticks, bool mirror);
	uint32_t longest;      /* steps of the longest axis */
	uint32_t oversampling; /* substeps in one of them */
	struct passo_phase accelerate, decelerate;
	uint64_t cruise;            /* ticks */
	uint64_t start, peak, stop; /* UQ0.48 substeps per clock */
};

/* Check machine, steps and profile; begin a draft. */
enum passo_plan_error passo_draft_start(struct passo_draft *draft, const struct passo_machine *machine,
    const int32_t *steps, enum passo_profile profile);

/* From a draft to a plan, which is touched only if it is good.
 *
 * In a given time: as passo_plan_in_time().
 * In ticks: so many, of which each ramp takes `ramp`, but at most half; the peak never above a limit that the
 * caller knows to be reached only by rounding.
 * By speed: the quickest within the limits; as passo_plan_by_speed(). */
enum passo_plan_error passo_draft_in_time(
    struct passo_draft *draft, uint64_t total_clocks, uint64_t ramp_clocks, struct passo_plan *plan);
enum passo_plan_error passo_draft_in_ticks(
    struct passo_draft *draft, uint64_t total, uint64_t ramp, uint64_t speed_limit, struct passo_plan *plan);
enum passo_plan_error passo_draft_by_speed(
    struct passo_draft *draft, const struct passo_limits *limits, struct passo_plan *plan);

/* The steps of it, in this order. Ramps must be weighed before their distance or weight is asked for.
 * passo_draft_distance() is what the peak has to cover, in units of velocity times weight. */
bool passo_draft_is_too_long(const struct passo_draft *draft);
uint64_t passo_draft_halvable(const struct passo_draft *draft, uint64_t ticks);
void passo_draft_weigh(struct passo_draft *draft);
void passo_draft_oversample_to(struct passo_draft *draft, uint64_t fit);
uint64_t passo_draft_weight(const struct passo_draft *draft);
struct passo_u128 passo_draft_distance(const struct passo_draft *draft);
void passo_draft_solve(struct passo_draft *draft);
void passo_draft_finish(const struct passo_draft *draft, struct passo_plan *plan);
uint64_t passo_oversampling_at(const struct passo_machine *machine, uint64_t speed);

/* What a move by speed keeps to. */
struct passo_limits passo_limits_of(const struct passo_move_by_speed *move);

/* Give a draft as many substeps per step as this speed of its longest axis allows; 0 if it is too fast. */
uint32_t passo_draft_oversample(struct passo_draft *draft, uint64_t speed);

/* The velocity that is this speed, rounded down. */
uint64_t passo_draft_velocity(const struct passo_draft *draft, uint64_t speed);

/* Append a ramp of a shape, not mirrored unless said so. */
void passo_plan_add_ramp(
    struct passo_plan *plan, enum passo_shape shape, bool mirror, uint64_t velocity_end, uint64_t ticks);

/* What a symmetric shape's ramp lacks in weight because its progress does not end at exactly 1:
 * ticks^2 * lack / divisor, where the divisor is 2 * ticks for a ramp alone. It can be negative. */
int64_t passo_lacking_weight(uint64_t ticks, uint64_t divisor);

uint64_t passo_ticks_nearest(const struct passo_machine *machine, uint64_t clocks);
uint64_t passo_ticks_ceil(const struct passo_machine *machine, uint64_t clocks);

static inline uint64_t passo_smaller(uint64_t a, uint64_t b)
{
	return a < b ? a : b;
}

#endif
