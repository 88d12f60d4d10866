/* SPDX-License-Identifier: MIT
 * Internal state of the model: encoders, following error, follower. See passo_model.h.
 */
#ifndef PASSO_CORE_ENCODER_H
#define PASSO_CORE_ENCODER_H

#include <stdbool.h>
#include <stdint.h>

struct passo_encoder_filter {
	uint8_t sync; /* 2 bits */
	uint8_t count;
	bool level;
};

struct passo_encoder {
	struct passo_encoder_filter a, b, index;
	bool a_q, b_q, active_q;
	bool count_made, count_down, slipped, index_event;
	uint8_t illegal;
};

struct passo_encoder_wires {
	bool a, b, index; /* pins */
	uint8_t filter;   /* clocks */
	bool inverted, index_inverted, index_gated;
	bool clear;
};

void passo_encoder_reset(struct passo_encoder *encoder);
/* Synchronous reset in the clock just simulated; `before` is the state before that clock. */
void passo_encoder_restart(struct passo_encoder *encoder, const struct passo_encoder *before);
void passo_encoder_clock(struct passo_encoder *encoder, const struct passo_encoder_wires *wires);
/* Clocks in which only filters count, until a pin or a setting changes; and skipping them. */
uint64_t passo_encoder_quiet(const struct passo_encoder *encoder, const struct passo_encoder_wires *wires);
void passo_encoder_skip(struct passo_encoder *encoder, uint64_t clocks);

struct passo_following {
	int64_t change, error; /* s18.16 */
	bool exceeded;
	uint32_t magnitude, greatest; /* counts */
};

struct passo_following_wires {
	bool zero, clear;
	bool step_made, step_direction;
	bool count_made, count_down;
	uint32_t ratio; /* UQ16.16 counts per step */
	uint16_t limit; /* counts */
};

void passo_following_clock(struct passo_following *following, const struct passo_following_wires *wires);
bool passo_following_quiet(
    const struct passo_following *following, const struct passo_following_wires *wires);

/* One axis: encoder, settings, following error. See rtl/passo_encoder_axis.v. */
struct passo_encoder_axis {
	bool inverted, index_inverted, index_gated, stops_soft, stops_hard;
	uint32_t ratio;
	uint16_t limit;
	struct passo_encoder encoder;
	struct passo_following following;
	uint32_t count; /* the RTL has it in passo_positions and, its lower half, beside the latch */
	uint16_t latch;
	uint8_t indexes;
	bool index_event_q;
};

struct passo_follower {
	int32_t change; /* of the count in the clock before */
	int32_t owed;   /* 24 bits */
	bool due, credit, behind, lost;
	uint32_t sum;
};

struct passo_follower_wires {
	bool following;
	bool count_made, count_down, slipped;
	uint8_t scale;
	uint32_t limit; /* UQ0.32 advances per enabled clock */
	bool enable, stall;
};

void passo_follower_reset(struct passo_follower *follower);
bool passo_follower_advance(const struct passo_follower *follower, const struct passo_follower_wires *wires);
void passo_follower_clock(struct passo_follower *follower, const struct passo_follower_wires *wires);
/* Clocks without an enabled one, until the next count; and skipping them. */
uint64_t passo_follower_quiet(
    const struct passo_follower *follower, const struct passo_follower_wires *wires);
void passo_follower_skip(
    struct passo_follower *follower, const struct passo_follower_wires *wires, uint64_t clocks);

#endif
