/* SPDX-License-Identifier: MIT
 * Internal state of the model: one struct and one source file per RTL module, with the names of the RTL.
 *
 * All modules change on the same edge. A parent therefore first gathers the wires between its modules from
 * the state before the edge and then clocks each module with these wires, in any order.
 */
#ifndef PASSO_MODEL_H
#define PASSO_MODEL_H

#include "passo_command.h"
#include "passo_core_encoder.h"
#include "passo_core_outputs.h"
#include "passo_core_trackers.h"
#include "passo_pins.h"
#include "passo_registers.h"
#include "passo_shapes.h"

#define PASSO_PAYLOAD_MAX 60u
#define PASSO_LINE_QUEUE_MAX 256u
#define PASSO_RAMP_QUEUE_MAX 256u
#define PASSO_RATE_ONE 0x10000u /* UQ1.16 */

/* ---- link side ---- */

struct passo_spi {
	uint8_t bit_count;
	bool mosi;
	bool first_word;
	uint32_t shift; /* 31 bits */
	bool mosi_late;
	bool half_toggle;
	bool half_low;
	uint16_t half;
	bool miso;
	uint8_t select_sync;
	uint8_t toggle_sync;
};

struct passo_spi_wires {
	bool frame_start, frame_end, half_valid;
};

struct passo_spi_wires passo_spi_wires(const struct passo_spi *spi);
void passo_spi_reset(struct passo_spi *spi);

/* The SCLK edge since the last clock, then the edge of clk. */
void passo_spi_clock(
    struct passo_spi *spi, bool sclk_was, bool sclk, bool mosi, bool cs_n, uint32_t reply_word);

struct passo_bus {
	bool frame, commit, check, write, read, push;
	uint16_t address;
	uint32_t data;
};

struct passo_response {
	bool claim;
	uint8_t refusal;
	uint32_t read_data;
	bool reads;       /* what is sampled in the clock of the response, too ... */
	uint16_t address; /* ... from this register */
};

enum passo_link_step {
	PASSO_LINK_IDLE,
	PASSO_LINK_HEADER,
	PASSO_LINK_PAYLOAD,
	PASSO_LINK_CRC,
	PASSO_LINK_ACK,
	PASSO_LINK_REPLAY,
	PASSO_LINK_READ,
	PASSO_LINK_SUM,
	PASSO_LINK_COUNT
};

/* Entries of the payload buffer after the payload. */
#define PASSO_BUFFER_HEADER 64u
#define PASSO_BUFFER_OTHER 65u
#define PASSO_BUFFER_WORDS 66u

struct passo_link {
	enum passo_link_step step;
	uint8_t count;
	bool is_read;
	uint8_t length;
	uint8_t index;
	bool all_words; /* index was length in the previous clock */
	bool frame_waits;
	bool sequence_known;
	uint8_t last_sequence;
	uint8_t verdict;
	bool answer_due;  /* the response comes in this clock */
	bool answer_came; /* `answer` holds it */
	uint8_t answer;   /* of the previous clock */
	bool crc_wrong;
	uint32_t crc;
	uint16_t buffer[PASSO_BUFFER_WORDS][2]; /* upper half first */
	uint32_t status;                        /* of the previous clock */
	uint32_t reply_word;
	bool refused;
	struct passo_bus bus;
};

struct passo_link_wires {
	struct passo_spi_wires spi;
	bool half_low;
	uint16_t half;
	uint32_t status;
	struct passo_response response;
	bool incomplete;
	bool busy;
};

void passo_link_reset(struct passo_link *link);
void passo_link_clock(struct passo_link *link, const struct passo_link_wires *wires);
/* Clocks in which the link only counts, UINT64_MAX at rest; and skipping them. */
uint64_t passo_link_quiet(const struct passo_link *link);
void passo_link_skip(struct passo_link *link, uint64_t clocks);

struct passo_registers {
	uint8_t run;
	uint8_t wait_sync;
	uint8_t status_channel;
	uint8_t refusals[8]; /* counters, BAD_CRC first */
};

/* ---- tables ---- */

struct passo_tables {
	uint16_t points[PASSO_BANKS][PASSO_BANK_POINTS];
	uint8_t slot; /* 2 * channel + second */
	bool wanted;  /* the current frame writes points */
};

/* ---- admission ---- */

/* State of the channel that the frame on the bus requires. */
struct passo_admission {
	bool idle_needed, quiet_needed, motion_needed;
};

/* State of the channel that a checked word requires. */
struct passo_needs {
	bool idle, quiet, motion;
};

/* ---- channel ---- */

struct passo_line_queue {
	uint8_t index;
	uint16_t write_line, next_line; /* one bit wider than the address */
	uint16_t write_end;             /* write_line after the current frame */
	uint16_t current_line;
	bool has_place; /* the current line occupies an entry */
	uint16_t checked;
	uint32_t checked_substeps;
	uint16_t room;
	bool full; /* for the frame so far, in the previous clock */
	bool next_valid;
	struct passo_line lines[PASSO_LINE_QUEUE_MAX];
	uint32_t output_words[PASSO_LINE_QUEUE_MAX]; /* of the lines, with OUTPUTS */
	/* outputs of the block RAM */
	bool last, endless;
	uint32_t last_substep; /* M - 1 */
	uint8_t directions;
	uint32_t steps[PASSO_AXES_MAX];
	uint32_t output_word;
};

struct passo_ramp_queue {
	uint8_t index;
	uint16_t write_ramp, write_end, read_ramp, now_ramp;
	uint16_t checked;
	bool velocity_is_max;
	bool write_low;
	bool is_now;
	bool now_pending;
	uint16_t room;
	bool full; /* for the frame so far, in the previous clock */
	bool valid;
	uint32_t words[PASSO_RAMP_QUEUE_MAX][5];
};

struct passo_timescale {
	uint32_t rate, goal, slew; /* UQ1.16 */
	uint8_t after;             /* clocks since the slew tick, until the rate changes; else 0 */
	bool down;
	bool stops; /* a stop was in progress at the slew tick */
	bool still;
	uint32_t rate_sum;
	bool enable;
};

enum passo_ramp_step {
	PASSO_RAMP_CHOOSE,
	PASSO_RAMP_COPY,
	PASSO_RAMP_FETCH,
	PASSO_RAMP_TAKE,
	PASSO_RAMP_WORK, /* look up, shape, scale */
	PASSO_RAMP_STEP
};

struct passo_ramp_unit {
	enum passo_ramp_step step;
	uint32_t wait; /* clocks until the step is complete */
	bool take_now;
	bool loaded, last, mirror;
	enum passo_shape shape;
	uint64_t v_start;
	uint64_t v_end, progress_step; /* the RTL reads them from the queue */
	uint32_t ticks;                /* remaining */
	uint64_t progress;             /* u, UQ0.49 */
	uint32_t tick_count;
	bool ready, unready, ends_next, dry;
	uint64_t velocity_next;
};

struct passo_path {
	uint32_t velocity_low, velocity_high, phase_low, phase_high; /* 24 bits each */
	bool phase_low_carry;
	bool refresh, take_q, advance_q;
	bool substep;
};

struct passo_line_unit {
	bool active, endless, ended, underrun;
	uint32_t substep_number;
	bool on_last;
	uint8_t directions;
	uint8_t moves; /* axes that the line has steps of */
	bool add_n, load_start, decide_step, load_start_q;
	bool no_repeat, no_repeat_before; /* the trigger has ended the ENDLESS line */
};

struct passo_dda {
	int64_t e_minus_m;
	int64_t addend;
};

/* READY and HOLD: idle; PULSE: STEP is active or in its low time. */
enum passo_axis_state { PASSO_AXIS_READY, PASSO_AXIS_PULSE, PASSO_AXIS_HOLD, PASSO_AXIS_SETUP };

struct passo_axis_settings {
	uint16_t step_high, step_low, dir_setup, dir_hold; /* clocks */
	bool half_written; /* of a timing; the other half is written in this clock */
	bool enable, step_inverted, direction_inverted, enable_inverted, both_edges;
	uint8_t inputs; /* register INPUTS */
};

/* Steps refused in a direction; see rtl/passo_limits.v. */
struct passo_closed {
	bool low, high;
};

struct passo_axis {
	struct passo_axis_settings settings;
	enum passo_axis_state state;
	uint16_t timer;
	uint8_t waiting, waits; /* queue: direction, and occupied; one bit per entry */
	bool step, dir;
	bool over;      /* the time of the state ends with this clock */
	bool restarts;  /* the previous clock wrote a timing or PINS, or was a reset */
	bool settle;    /* PINS was written in the previous clock */
	bool unsettled; /* no DIR setup time has elapsed since */
	bool quiet;     /* of the previous clock */
	bool step_made;
	bool overrun;
	struct passo_closed closed; /* in the previous clock */
	uint32_t position;
	uint8_t lost;
	bool step_pin, dir_pin, enable_pin;
};

struct passo_positions {
	uint8_t slot; /* clock within the round */
	bool clear_waits, snapshot_waits, latch_waits;
	uint32_t copies[PASSO_AXES_MAX];
	uint32_t latched[PASSO_AXES_MAX], latched_copies[PASSO_AXES_MAX];
};

struct passo_motion {
	enum passo_state state;
	enum passo_cause cause;
	enum passo_cause soft_cause;
	bool stopping;
	uint16_t drained; /* 15 bits */
	uint8_t count;
	uint8_t settling; /* 3 bits */
	bool settled;
	bool startable;
	bool synced; /* sync rose while it was ARMED */
	bool begin_profile;
	bool stop_due;
	enum passo_cause cause_due;
	bool rate_was_zero;
	uint8_t aborted; /* bits 0 and 1: one and two clocks ago */
	bool running;
};

/* The profile runs, settles, or missing substeps are drained. */
static inline bool passo_motion_moves(const struct passo_motion *motion)
{
	return motion->state == PASSO_STATE_RUN || motion->state == PASSO_STATE_SETTLE
	    || motion->state == PASSO_STATE_DRAIN;
}

struct passo_channel_registers {
	uint32_t rate_target, rate_slew, stop_slew; /* UQ1.16 */
	uint32_t drain_velocity;                    /* UQ0.32 */
	bool drain_velocity_written;                /* its lower 8 bits, in the previous clock */
	bool command_stop, command_abort, command_clear, command_zero;
};

/* ---- inputs of the machine ---- */

/* Pins of one kind, a bit per axis; see rtl/passo_input.v. */
struct passo_input_filter {
	uint8_t first, second, level, pending, was_active;
};

/* Whether the levels are known: an input has changed since the last tick; one clock after a change of
 * polarity or filter. */
struct passo_settling {
	bool changed, forgot, unknown;
};

enum passo_input_kind {
	PASSO_KIND_LIMIT_LOW,
	PASSO_KIND_LIMIT_HIGH,
	PASSO_KIND_HOME,
	PASSO_KIND_ALARM,
	PASSO_KIND_PROBE,
	PASSO_KINDS
};

struct passo_limits {
	uint8_t closed_low, closed_high;
	bool limit_hard, limit_softly, alarm_hard, alarm_softly;
	uint8_t named;
};

struct passo_trigger {
	uint8_t source, axis, action;
	bool falling;
	uint8_t stale; /* clocks until `picked` is that of the source */
	bool picked, level, arming, armed, fired, latch;
	uint16_t count;
};

/* Inputs of a channel; see rtl/passo_inputs.v. */
struct passo_inputs_unit {
	struct passo_input_filter input[PASSO_KINDS];
	struct passo_settling settling;
	struct passo_limits limits;
	struct passo_trigger trigger;
	bool probe_inverted;
};

/* Shared by the inputs of all channels; see rtl/passo_machine.v. */
struct passo_machine_unit {
	uint16_t filter, count;
	bool tick;
	bool estop_pressed;
	uint8_t estop_released, estop_seen; /* 2 bits */
	uint16_t watchdog_stop_after, watchdog_disable_after;
	uint32_t watchdog_count; /* slew ticks */
	bool watchdog_holds, watchdog_silent, watchdog_stop, watchdog_disable;
};

/* What it sees of the channels and the core. */
struct passo_machine_wires {
	unsigned tick_log2;
	bool moving, slew_tick;
};

/* What a channel asks its motion, axes and line to do. */
struct passo_requests {
	bool hard, soft, latch, end_endless;
	bool wait; /* no motion may begin: an input is unknown, or the trigger is being armed */
	enum passo_cause hard_cause, soft_cause;
	uint8_t disable; /* a bit per axis */
};

/* ---- encoders ---- */

struct passo_encoders {
	bool present; /* ENCODERS */
	struct passo_encoder_axis axis[PASSO_AXES_MAX];
	bool follow, wait_index;
	uint8_t source, scale;
	uint32_t follow_limit; /* UQ0.32 */
	uint8_t filter;
	struct passo_follower follower;
	bool was_behind, was_lost;
	bool stop_soft, stop_hard;
	struct passo_positions positions;
	bool writes;     /* bus write strobe for one of the registers, one clock late */
	uint8_t written; /* its address within the channel */
};

struct passo_channel {
	uint8_t axes;
	uint8_t number;
	bool has_outputs; /* OUTPUTS */
	bool has_raster;  /* RASTER */
	struct passo_channel_registers registers;
	struct passo_admission admission;
	struct passo_line_queue line_queue;
	struct passo_ramp_queue ramp_queue;
	struct passo_motion motion;
	struct passo_timescale timescale;
	struct passo_ramp_unit ramp;
	struct passo_path path;
	struct passo_line_unit line;
	struct passo_dda dda[PASSO_AXES_MAX];
	struct passo_axis axis[PASSO_AXES_MAX];
	struct passo_positions positions;
	struct passo_inputs_unit inputs;
	struct passo_encoders encoders;
	struct passo_trackers trackers;
	struct passo_output_registers output_registers;
	struct passo_outputs_unit outputs;
	uint8_t occupied_before; /* in the previous three clocks */
	bool at_rest;     /* no motion, no step in flight to the axes, no change of the outputs waits */
	bool writes_axis; /* bus write strobe for the axes, one clock late */
	uint8_t written_register; /* its address within the axis blocks */
};

/* Signals from the core to a channel. */
struct passo_channel_inputs {
	const struct passo_parameters *parameters;
	const struct passo_tables *tables;
	const struct passo_bus *bus;
	bool run, wait_sync, sync_edge, slew_tick, snapshot;
	bool tables_wanted;
	bool needs_quiet;                            /* of the register that is checked */
	const struct passo_machine_unit *machine;    /* before the edge */
	uint8_t pins[PASSO_KINDS];                   /* levels, a bit per axis */
	uint8_t encoder_a, encoder_b, encoder_index; /* pins, one bit per axis */
};

/* The wires of a channel, from the state before the edge. */
struct passo_channel_wires {
	bool selected;       /* the bus address is in this channel */
	uint8_t bus_address; /* within the channel */
	bool line_push, ramp_push;
	bool occupied, moving, counting, drain;
	bool tracking; /* an axis moves without a motion, or beside it */
	bool ramp_valid;
	bool hold, now_coming; /* from the admission */
	bool startable, prepare, synced_next, begins_next, begin_profile;
	bool may_begin, follows;
	bool too_far, lags; /* from the encoders: a hard stop, a soft stop */
	bool stall;
	bool advance, tick, next, ramp_ended;
	bool substep_taken, line_done, take, repeats;
	bool overrun;
	bool finished;
	bool stop_now, stopped;
	bool running_next; /* the pin after this clock */
	bool drop;
	bool estop;
	struct passo_requests requests;
};

/* What the frame being executed keeps a motion from: `hold` and `now_coming`. */
void passo_admission_wires(const struct passo_admission *admission, const struct passo_bus *bus,
    bool tables_wanted, struct passo_channel_wires *wires);
void passo_admission_clock(
    struct passo_admission *admission, const struct passo_bus *bus, const struct passo_needs *needs);

void passo_line_queue_clock(struct passo_line_queue *queue, const struct passo_parameters *parameters,
    const struct passo_bus *bus, const struct passo_channel_wires *wires);
uint8_t passo_line_queue_refusal(const struct passo_line_queue *queue,
    const struct passo_parameters *parameters, const struct passo_bus *bus, bool blocked);

void passo_ramp_queue_clock(struct passo_ramp_queue *queue, const struct passo_parameters *parameters,
    const struct passo_bus *bus, const struct passo_channel_wires *wires, bool take, bool take_now);
uint8_t passo_ramp_queue_refusal(
    const struct passo_ramp_queue *queue, const struct passo_bus *bus, bool blocked);
/* Whether the checked word is the control word of a NOW ramp. */
bool passo_ramp_queue_checks_now(const struct passo_ramp_queue *queue, uint32_t data);
/* The oldest ramp in the queue. */
struct passo_ramp passo_ramp_queue_front(
    const struct passo_ramp_queue *queue, const struct passo_parameters *parameters);

void passo_timescale_clock(struct passo_timescale *timescale, const struct passo_channel_registers *registers,
    bool moving, bool stopping, bool slew_tick);

/* a + floor((b - a) * f), f as UQ1.24 */
uint64_t passo_interpolate(uint64_t a, uint64_t b, uint32_t f);
/* s as UQ1.24 for progress u as UQ0.49. */
uint32_t passo_shape(const struct passo_tables *tables, enum passo_shape shape, uint64_t progress);
/* Computes velocity_next, the velocity of the next tick of the present ramp. */
void passo_ramp_make_velocity(struct passo_ramp_unit *ramp, const struct passo_tables *tables);
/* The same for many ticks of a ramp of constant velocity, which is velocity_next already. */
void passo_ramp_hold(struct passo_ramp_unit *ramp, uint32_t ticks);
void passo_ramp_clock(struct passo_ramp_unit *ramp, const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, const struct passo_channel_wires *wires, bool *take,
    bool *take_now);

void passo_path_reset(struct passo_path *path);
void passo_path_clock(struct passo_path *path, const struct passo_ramp_unit *ramp,
    const struct passo_channel_wires *wires, uint32_t drain_velocity);

/* What a substep does to the line; it needs `prepare`. */
void passo_line_wires(const struct passo_line_unit *line, const struct passo_line_queue *queue, bool substep,
    struct passo_channel_wires *wires);
int64_t passo_line_addend(const struct passo_line_unit *line, uint32_t last_substep);
void passo_line_clock(struct passo_line_unit *line, const struct passo_line_queue *queue,
    const struct passo_channel_wires *wires);

bool passo_dda_step_request(const struct passo_dda *dda, const struct passo_line_unit *line);
void passo_dda_clock(struct passo_dda *dda, const struct passo_line_unit *line,
    const struct passo_line_queue *queue, unsigned axis);

struct passo_axis_wires {
	bool step_request, direction;
	bool drop, zero, clear, timing_written, pins_written;
	bool both_edges_next; /* with pins_written: the value written */
	struct passo_closed closed;
};

/* State after configuration, with the levels of the three pins. */
void passo_axis_reset(struct passo_axis *axis, bool step, bool dir, bool enable);
/* Synchronous reset in the clock just simulated; `before` is the state before that clock. */
void passo_axis_restart(struct passo_axis *axis, const struct passo_axis *before);
void passo_axis_clock(struct passo_axis *axis, const struct passo_axis_wires *wires);
/* Clocks for which only the timer changes; 0 if the next clock may change something else. */
uint32_t passo_axis_quiet(const struct passo_axis *axis, bool line_direction);
void passo_axis_skip(struct passo_axis *axis, uint64_t clocks);

void passo_positions_reset(struct passo_positions *positions);
void passo_positions_clock(struct passo_positions *positions, const uint32_t values[PASSO_AXES_MAX],
    bool zero, bool snapshot, bool latch);
/* Clocks until a pending snapshot is taken, UINT64_MAX if none is; and skipping such clocks without `zero`
 * and `snapshot`. */
uint64_t passo_positions_quiet(const struct passo_positions *positions);
void passo_positions_skip(struct passo_positions *positions, uint64_t clocks);

void passo_machine_reset(struct passo_machine_unit *machine);
/* Synchronous reset in the clock just simulated, which keeps the filter and an e-stop. */
void passo_machine_restart(struct passo_machine_unit *machine, const struct passo_machine_unit *before);
void passo_machine_clock(struct passo_machine_unit *machine, const struct passo_bus *bus,
    const struct passo_inputs *inputs, const struct passo_machine_wires *wires);
/* Clocks until more changes than counters; and skipping such clocks, which see this many slew ticks. */
uint64_t passo_machine_quiet(const struct passo_machine_unit *machine, const struct passo_inputs *inputs,
    const struct passo_machine_wires *wires, uint64_t clocks_to_slew);
void passo_machine_skip(struct passo_machine_unit *machine, uint64_t clocks, uint64_t slew_ticks);

struct passo_requests passo_inputs_requests(
    const struct passo_channel *channel, const struct passo_channel_inputs *inputs);
void passo_inputs_clock(struct passo_inputs_unit *unit, const struct passo_channel *channel,
    const struct passo_channel_inputs *inputs, const struct passo_channel_wires *wires);
/* State after a reset; and the synchronous reset, which keeps the settings. */
void passo_inputs_reset(struct passo_inputs_unit *unit);
void passo_inputs_restart(struct passo_inputs_unit *unit, const struct passo_inputs_unit *before);
/* Whether a word of TRIGGER names a source or an axis that the core does not have. */
bool passo_trigger_objects(const struct passo_channel *channel, uint32_t data);
/* `forget`: polarity or filter change with this clock. */
void passo_trigger_clock(struct passo_trigger *trigger, const struct passo_inputs_unit *unit, uint8_t index,
    uint16_t filter, bool forget);
/* Clocks for which only its counters change, and skipping them. */
uint64_t passo_trigger_quiet(const struct passo_trigger *trigger, const struct passo_inputs_unit *unit,
    uint8_t index, uint16_t filter);
void passo_trigger_skip(struct passo_trigger *trigger, uint64_t clocks);
void passo_trigger_write(struct passo_trigger *trigger, uint32_t data);
uint32_t passo_inputs_value(const struct passo_inputs_unit *unit, uint8_t address);
/* Clocks for which nothing changes except the counters of the trigger, and skipping them. */
uint64_t passo_inputs_quiet(const struct passo_channel *channel, const struct passo_channel_inputs *inputs);
void passo_inputs_skip(struct passo_inputs_unit *unit, uint64_t clocks);
/* The pins of a channel among those of the core. */
void passo_encoders_pins(
    struct passo_channel_inputs *inputs, const struct passo_inputs *pins, unsigned channel);
void passo_encoders_reset(struct passo_encoders *encoders, bool present);
/* Synchronous reset with these pins; `before` is the state before the clock. */
void passo_encoders_restart(struct passo_encoders *encoders, const struct passo_encoders *before,
    const struct passo_channel_inputs *inputs);
/* What the encoders say to motion and profile; they need `counting`, `drain` and `stall`. */
void passo_encoders_wires(const struct passo_channel *channel, struct passo_channel_wires *wires);
/* Whether the profile advances in this clock, while it follows. */
bool passo_encoders_advance(const struct passo_channel *channel, const struct passo_channel_wires *wires);
void passo_encoders_clock(struct passo_channel *channel, const struct passo_channel_inputs *inputs,
    const struct passo_channel_wires *wires);
void passo_encoder_registers_reset(struct passo_encoders *encoders);
/* The registers are written one clock after the strobe. */
void passo_encoder_registers_clock(
    struct passo_channel *channel, const struct passo_bus *bus, const struct passo_channel_wires *wires);
/* Value of a read-only register of the encoders. */
uint32_t passo_encoder_registers_value(const struct passo_channel *channel, uint8_t address);
/* Levels of the indexes as the setups have them, synchronized but not filtered, a bit per axis. */
uint8_t passo_encoders_index(const struct passo_channel *channel);
/* Whether an ARMED motion begins with an index. */
bool passo_encoders_await_index(const struct passo_channel *channel);
/* Whether the profile follows and nothing is owed to it: nothing moves. */
bool passo_encoders_wait(const struct passo_channel *channel);
/* Clocks in which only filters and sums count, until a pin or an axis changes; and skipping them. */
uint64_t passo_encoders_quiet(const struct passo_channel *channel, const struct passo_channel_inputs *inputs);
void passo_encoders_skip(struct passo_channel *channel, uint64_t clocks);

void passo_trackers_reset(struct passo_trackers *trackers, bool present);
/* Synchronous reset, which keeps what the host has written; `before` is the state before the clock. */
void passo_trackers_restart(struct passo_trackers *trackers, const struct passo_trackers *before);
/* The unit that serves all axes. */
void passo_tracker_clock(struct passo_channel *channel, const struct passo_bus *bus, bool selected,
    const struct passo_tracker_wires *wires);
/* Whether the trackers know whether the path runs; whether the line that runs moves an axis. */
bool passo_trackers_settled(const struct passo_channel *channel);
bool passo_trackers_path_moves(const struct passo_channel *channel, unsigned axis);
/* The step of an axis and its direction, of path and tracker; and a clock of all trackers. */
struct passo_tracker_join_result passo_trackers_join(const struct passo_channel *channel, unsigned axis);
void passo_trackers_clock(
    struct passo_channel *channel, const struct passo_bus *bus, const struct passo_channel_wires *wires);
/* Value of a register that is sampled in the clock of the response; 0 for others. */
uint32_t passo_trackers_value(const struct passo_channel *channel, uint8_t address);
/* Clocks in which nothing changes but whose turn it is, and skipping such clocks. */
uint64_t passo_trackers_quiet(const struct passo_channel *channel, const struct passo_channel_inputs *inputs);
void passo_trackers_skip(struct passo_channel *channel, uint64_t clocks);

void passo_motion_wires(const struct passo_channel *channel, const struct passo_channel_inputs *inputs,
    struct passo_channel_wires *wires);
void passo_motion_clock(struct passo_motion *motion, const struct passo_channel *channel,
    const struct passo_channel_wires *wires);

/* State of the channel that the bus strobe requires. */
struct passo_needs passo_channel_needs(
    const struct passo_channel *channel, const struct passo_bus *bus, bool needs_quiet);
/* Whether a register of the channel objects to a word that its rule allows. */
bool passo_channel_objects(const struct passo_channel *channel, uint8_t address, uint32_t data);
/* Refusal of the word that is pushed to a queue of the channel. */
uint8_t passo_channel_push_refusal(const struct passo_channel *channel,
    const struct passo_parameters *parameters, const struct passo_bus *bus);
/* Value of a register of the channel that is sampled in the clock of the strobe; 0 for others. */
uint32_t passo_channel_value_now(const struct passo_channel *channel, uint8_t address);
/* The same for those that are sampled in the clock of the response. */
uint32_t passo_channel_registers_value(const struct passo_channel *channel, uint8_t address);
void passo_channel_registers_reset(struct passo_channel_registers *registers);
void passo_channel_registers_clock(
    struct passo_channel_registers *registers, const struct passo_bus *bus, bool selected);
void passo_axis_settings_write(struct passo_axis_settings *settings, uint8_t address, uint32_t data);

void passo_channel_reset(
    struct passo_channel *channel, const struct passo_parameters *parameters, uint8_t number);
/* Synchronous reset in the clock just simulated; `before` is the state before that clock. */
void passo_channel_restart(struct passo_channel *channel, const struct passo_channel *before,
    const struct passo_parameters *parameters, const struct passo_inputs *pins);
void passo_channel_clock(struct passo_channel *channel, const struct passo_channel_inputs *inputs);
/* Inputs of the outputs, from the state before the edge. */
struct passo_outputs_wires passo_channel_outputs(const struct passo_channel *channel,
    const struct passo_bus *bus, const struct passo_channel_wires *wires);
bool passo_channel_stopped(const struct passo_channel *channel);
bool passo_channel_occupied(const struct passo_channel *channel);
bool passo_channel_quiet(const struct passo_channel *channel);
/* Whether the state of the channel does not allow the frame on the bus. */
bool passo_channel_busy(const struct passo_channel *channel);
bool passo_channel_incomplete(const struct passo_channel *channel);

#endif
