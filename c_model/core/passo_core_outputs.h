/* SPDX-License-Identifier: MIT
 * Model of the path-synchronized outputs. See rtl/passo_outputs.v.
 */
#ifndef PASSO_CORE_OUTPUTS_H
#define PASSO_CORE_OUTPUTS_H

#include <stdbool.h>
#include <stdint.h>

#include "passo_words.h"

#define PASSO_CHANGES_DEPTH 256u
#define PASSO_RASTER_DEPTH 256u /* words */

struct passo_output_settings {
	uint16_t lag;
	uint32_t pwm_step;        /* UQ0.24 */
	uint32_t power_reference; /* UQ0.32 */
	uint32_t pitch;           /* substeps */
	uint8_t compare_axis;
	uint16_t compare_width;
	uint32_t compare_interval; /* signed */
};

struct passo_output_registers {
	struct passo_output_settings settings;
	bool write_levels, write_power, write_pulse, write_distance; /* written in the previous clock */
};

struct passo_pwm {
	bool idle, begins;
	uint32_t phase, cost; /* UQ0.24 */
	int32_t credit;
	bool pin;
};

struct passo_power {
	uint8_t count;
	bool stale;               /* the settings were written since their product was begun */
	uint64_t scaled;          /* their product, half of it */
	uint32_t cost, next_cost; /* UQ0.24 */
};

struct passo_change {
	uint16_t time;
	struct passo_line_output word;
};

struct passo_changes {
	uint16_t now, due;
	uint16_t write_place, read_place; /* one bit wider than the address */
	bool full, valid, hit, overflow, empty;
	struct passo_change data; /* output of the block RAM */
	struct passo_change changes[PASSO_CHANGES_DEPTH];
};

struct passo_raster {
	uint16_t write_word, write_end, read_word; /* one bit wider than the address */
	uint16_t checked, room;
	bool full; /* for the frame so far, in the previous clock */
	uint8_t index;
	bool available, first, due, missed;
	uint32_t left;
	uint32_t word; /* output of the block RAM */
	uint32_t words[PASSO_RASTER_DEPTH];
};

struct passo_compare {
	uint32_t away; /* signed */
	bool one_up, one_down;
	uint16_t timer;
	bool pin;
};

/* Bus signals of a queue. */
struct passo_raster_bus {
	bool push; /* the bus addresses this queue */
	bool frame, commit, check, write;
	uint32_t data;
};

/* Inputs of the outputs in one clock. */
struct passo_outputs_wires {
	struct passo_raster_bus bus;
	struct passo_output_settings settings;
	struct passo_line_output word;
	bool write_pulse, write_distance, write_levels; /* with bus.data */
	bool write_power;                               /* pwm_step or power_reference may be new */
	bool line_begins, substep;
	bool stopped, clear, running, running_next;
	uint32_t velocity, rate;
	bool waits;                        /* the path waits for an encoder */
	uint8_t step_made, step_direction; /* one bit per axis */
};

struct passo_outputs_unit {
	struct passo_pwm pwm;
	struct passo_power power;
	struct passo_changes changes;
	struct passo_raster raster;
	struct passo_compare compare;
	struct passo_line_output now;
	bool lit, differs, restart;
	uint8_t still; /* bit n: velocity or rate was 0 n + 1 clocks ago */
	bool overflow, raster_empty;
	uint8_t levels; /* the pins */
};

/* The path in skipped clocks. */
struct passo_outputs_skipped {
	bool running;
	uint32_t velocity, rate, substeps, pwm_step;
};

struct passo_pwm_wires {
	bool go, restart, proportional;
	uint16_t power;
	uint32_t step, cost;
};

/* Of a clock with power. */
uint32_t passo_pwm_cost(bool proportional, uint32_t step, uint32_t cost);
void passo_pwm_clock(struct passo_pwm *pwm, const struct passo_pwm_wires *wires);
/* Clocks until the pin may change, 0 with proportional power; and skipping them. */
uint64_t passo_pwm_quiet(const struct passo_pwm *pwm, const struct passo_pwm_wires *wires);
void passo_pwm_skip(struct passo_pwm *pwm, uint32_t step, uint64_t clocks);

void passo_power_reset(struct passo_power *power);
void passo_power_clock(struct passo_power *power, const struct passo_outputs_wires *wires, bool moves);

void passo_changes_reset(struct passo_changes *changes);
void passo_changes_clock(struct passo_changes *changes, bool flush, uint16_t lag, bool change,
    const struct passo_line_output *word);
/* Whether none is pending, and only the counters change. */
bool passo_changes_steady(const struct passo_changes *changes, bool flush, uint16_t lag);

/* Whether the cost is being divided again and again, as it is while the path moves. */
bool passo_power_divides(const struct passo_power *power);
/* Skips clocks of that, at one velocity and rate. */
void passo_power_skip(struct passo_power *power, uint32_t velocity, uint32_t rate, uint64_t clocks);

void passo_raster_reset(struct passo_raster *raster);
/* Whether a substep takes a value, and the value. */
bool passo_raster_take(const struct passo_raster *raster, const struct passo_outputs_wires *wires);
uint8_t passo_raster_value(const struct passo_raster *raster);
uint8_t passo_raster_refusal(const struct passo_raster *raster, bool blocked);
void passo_raster_clock(struct passo_raster *raster, const struct passo_outputs_wires *wires);

/* Whether no state changes while no substep comes and the bus does nothing. */
bool passo_raster_steady(const struct passo_raster *raster, bool stopped);
/* Skips substeps that take no value. */
void passo_raster_skip(struct passo_raster *raster, uint32_t substeps);

void passo_compare_clock(struct passo_compare *compare, const struct passo_outputs_wires *wires);

void passo_outputs_reset(struct passo_outputs_unit *outputs);
void passo_outputs_clock(struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires);
/* Whether no change is pending, one clock late. */
bool passo_outputs_quiet(const struct passo_outputs_unit *outputs);
uint32_t passo_outputs_state(const struct passo_outputs_unit *outputs, bool has_raster);
/* Clocks in which no pin changes as long as the inputs stay as they are, and skipping them. */
uint64_t passo_outputs_steady(
    const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires);
/* Whether `substeps` of the present line change no output. */
bool passo_outputs_ignore(
    const struct passo_outputs_unit *outputs, const struct passo_outputs_wires *wires, uint32_t substeps);
void passo_outputs_skip(
    struct passo_outputs_unit *outputs, const struct passo_outputs_skipped *skipped, uint64_t clocks);

/* Whether the word of a register of the outputs names an axis that the core lacks. */
bool passo_output_registers_object(uint8_t address, uint32_t data, uint8_t axes);
void passo_output_registers_reset(struct passo_output_registers *registers);
void passo_output_registers_clock(
    struct passo_output_registers *registers, bool write, uint8_t address, uint32_t data);

#endif
