/* SPDX-License-Identifier: MIT
 * Generated from spec/passo.rdl by spec/generate_registers.py.
 *
 * The fields of words: what a frame has beside its payload, what is pushed, some registers.
 * What does not fit into a field is cut off.
 */
#ifndef PASSO_WORDS_H
#define PASSO_WORDS_H

#include <stdbool.h>
#include <stdint.h>

#include "passo_registers.h"

/* Header. First word of a request. */
struct passo_header {
	enum passo_operation operation; /* Requested operation. */
	uint8_t              sequence;  /* Must differ from that of the previous write or push. */
	uint8_t              length;    /* Words of payload or data, 1 .. 60. */
	uint16_t             address;   /* Address of the first register. */
};

static inline uint32_t passo_pack_header(const struct passo_header *word)
{
	return ((uint32_t)word->operation & 0xFu) << 28
	     | ((uint32_t)word->sequence & 0xFFu) << 20
	     | ((uint32_t)word->length & 0xFFu) << 12
	     | ((uint32_t)word->address & 0xFFFu);
}

static inline struct passo_header passo_unpack_header(uint32_t word)
{
	return (struct passo_header){
	    .operation = (enum passo_operation)(word >> 28 & 0xFu),
	    .sequence = (uint8_t)(word >> 20 & 0xFFu),
	    .length = (uint8_t)(word >> 12 & 0xFFu),
	    .address = (uint16_t)(word & 0xFFFu),
	};
}

/* Ack. Last word of the reply to a write or push, and to a refused read. */
struct passo_ack {
	uint8_t            sequence;     /* Sequence number of the request. */
	enum passo_verdict verdict;      /* Outcome of the frame. */
	uint8_t            not_sequence; /* The same, inverted. */
	uint8_t            not_verdict;  /* The same, inverted. */
};

static inline uint32_t passo_pack_ack(const struct passo_ack *word)
{
	return ((uint32_t)word->sequence & 0xFFu) << 24
	     | ((uint32_t)word->verdict & 0xFFu) << 16
	     | ((uint32_t)word->not_sequence & 0xFFu) << 8
	     | ((uint32_t)word->not_verdict & 0xFFu);
}

static inline struct passo_ack passo_unpack_ack(uint32_t word)
{
	return (struct passo_ack){
	    .sequence = (uint8_t)(word >> 24 & 0xFFu),
	    .verdict = (enum passo_verdict)(word >> 16 & 0xFFu),
	    .not_sequence = (uint8_t)(word >> 8 & 0xFFu),
	    .not_verdict = (uint8_t)(word & 0xFFu),
	};
}

/* Status. Sent in a reply before the ack or the data; sampled when chip select fell. */
struct passo_status {
	uint8_t marker;       /* Always 2. */
	bool    any_stopped;  /* At least one channel is STOPPED. */
	bool    any_occupied; /* At least one channel has a motion prepared or running. */
	bool    zero;         /* Always 0. */
	uint8_t channel;      /* RUN.STATUS_CHANNEL: the channel whose room follows. */
	uint8_t sequence;     /* Sequence number of the last write or push executed. */
	uint8_t line_room;    /* Free places for lines, 255 = 255 or more. */
	uint8_t ramp_room;    /* Free places for ramps, 255 = 255 or more. */
};

static inline uint32_t passo_pack_status(const struct passo_status *word)
{
	return ((uint32_t)word->marker & 0x3u) << 30
	     | ((uint32_t)word->any_stopped & 0x1u) << 29
	     | ((uint32_t)word->any_occupied & 0x1u) << 28
	     | ((uint32_t)word->zero & 0x1u) << 27
	     | ((uint32_t)word->channel & 0x7u) << 24
	     | ((uint32_t)word->sequence & 0xFFu) << 16
	     | ((uint32_t)word->line_room & 0xFFu) << 8
	     | ((uint32_t)word->ramp_room & 0xFFu);
}

static inline struct passo_status passo_unpack_status(uint32_t word)
{
	return (struct passo_status){
	    .marker = (uint8_t)(word >> 30 & 0x3u),
	    .any_stopped = (word >> 29 & 0x1u) != 0u,
	    .any_occupied = (word >> 28 & 0x1u) != 0u,
	    .zero = (word >> 27 & 0x1u) != 0u,
	    .channel = (uint8_t)(word >> 24 & 0x7u),
	    .sequence = (uint8_t)(word >> 16 & 0xFFu),
	    .line_room = (uint8_t)(word >> 8 & 0xFFu),
	    .ramp_room = (uint8_t)(word & 0xFFu),
	};
}

/* Line control. First word of a line; then M, N_0 .. N_{AXES-1} and, with OUTPUTS, its output. */
struct passo_line_control {
	uint8_t directions; /* Bit i: axis i counts down. */
	bool    endless;    /* Repeat until the profile ends. */
	bool    last;       /* The path ends with this line. */
};

static inline uint32_t passo_pack_line_control(const struct passo_line_control *word)
{
	return ((uint32_t)word->directions & 0xFFu) << 8
	     | ((uint32_t)word->endless & 0x1u) << 1
	     | ((uint32_t)word->last & 0x1u);
}

static inline struct passo_line_control passo_unpack_line_control(uint32_t word)
{
	return (struct passo_line_control){
	    .directions = (uint8_t)(word >> 8 & 0xFFu),
	    .endless = (word >> 1 & 0x1u) != 0u,
	    .last = (word & 0x1u) != 0u,
	};
}

/* Ramp control. First word of a ramp; then the lower bits of v_end, T, and the progress step in two words. */
struct passo_ramp_control {
	uint16_t         velocity_high; /* v_end, UQ0.48, bits 47:32. */
	enum passo_shape shape;         /* Shape of the ramp. */
	bool             mirror;        /* 1 - shape(1 - u) instead of shape(u). */
	bool             now;           /* Drop the queued ramps before it and start from the present velocity. */
	bool             last;          /* The profile ends with this ramp. */
};

static inline uint32_t passo_pack_ramp_control(const struct passo_ramp_control *word)
{
	return ((uint32_t)word->velocity_high & 0xFFFFu) << 16
	     | ((uint32_t)word->shape & 0x3u) << 4
	     | ((uint32_t)word->mirror & 0x1u) << 2
	     | ((uint32_t)word->now & 0x1u) << 1
	     | ((uint32_t)word->last & 0x1u);
}

static inline struct passo_ramp_control passo_unpack_ramp_control(uint32_t word)
{
	return (struct passo_ramp_control){
	    .velocity_high = (uint16_t)(word >> 16 & 0xFFFFu),
	    .shape = (enum passo_shape)(word >> 4 & 0x3u),
	    .mirror = (word >> 2 & 0x1u) != 0u,
	    .now = (word >> 1 & 0x1u) != 0u,
	    .last = (word & 0x1u) != 0u,
	};
}

/* Line output. With OUTPUTS the last word of a line. */
struct passo_line_output {
	bool     raster;       /* The power comes from the raster queue (with RASTER); the field is then 0. */
	bool     proportional; /* Power in proportion to the present velocity. */
	uint8_t  levels;       /* Levels of the digital outputs. */
	uint16_t power;        /* Power, UQ0.16, but 65535 is 1.0. */
};

static inline uint32_t passo_pack_line_output(const struct passo_line_output *word)
{
	return ((uint32_t)word->raster & 0x1u) << 25
	     | ((uint32_t)word->proportional & 0x1u) << 24
	     | ((uint32_t)word->levels & 0xFFu) << 16
	     | ((uint32_t)word->power & 0xFFFFu);
}

static inline struct passo_line_output passo_unpack_line_output(uint32_t word)
{
	return (struct passo_line_output){
	    .raster = (word >> 25 & 0x1u) != 0u,
	    .proportional = (word >> 24 & 0x1u) != 0u,
	    .levels = (uint8_t)(word >> 16 & 0xFFu),
	    .power = (uint16_t)(word & 0xFFFFu),
	};
}

/* Version. Version of the register map and the link. That of the release is in the file VERSION of the repository. */
struct passo_version {
	uint8_t major; /* Major. */
	uint8_t minor; /* Minor. */
	uint8_t patch; /* Patch. */
};

static inline uint32_t passo_pack_version(const struct passo_version *word)
{
	return ((uint32_t)word->major & 0xFFu) << 16
	     | ((uint32_t)word->minor & 0xFFu) << 8
	     | ((uint32_t)word->patch & 0xFFu);
}

static inline struct passo_version passo_unpack_version(uint32_t word)
{
	return (struct passo_version){
	    .major = (uint8_t)(word >> 16 & 0xFFu),
	    .minor = (uint8_t)(word >> 8 & 0xFFu),
	    .patch = (uint8_t)(word & 0xFFu),
	};
}

/* Parameters. How the core was built. */
struct passo_parameters_word {
	bool    outputs;         /* OUTPUTS. */
	bool    encoders;        /* ENCODERS. */
	bool    inputs;          /* INPUTS. */
	uint8_t ramp_queue_log2; /* RAMP_QUEUE_LOG2. */
	uint8_t tracked;         /* TRACKED. */
	uint8_t line_queue_log2; /* LINE_QUEUE_LOG2. */
	bool    trackers;        /* TRACKERS. */
	bool    compare;         /* COMPARE. */
	bool    raster;          /* RASTER. */
	uint8_t tick_log2;       /* TICK_LOG2. */
	uint8_t axes;            /* AXES per channel. */
	uint8_t channels;        /* CHANNELS. */
};

static inline uint32_t passo_pack_parameters(const struct passo_parameters_word *word)
{
	return ((uint32_t)word->outputs & 0x1u) << 31
	     | ((uint32_t)word->encoders & 0x1u) << 30
	     | ((uint32_t)word->inputs & 0x1u) << 29
	     | ((uint32_t)word->ramp_queue_log2 & 0x1Fu) << 24
	     | ((uint32_t)word->tracked & 0x7u) << 21
	     | ((uint32_t)word->line_queue_log2 & 0x1Fu) << 16
	     | ((uint32_t)word->trackers & 0x1u) << 15
	     | ((uint32_t)word->compare & 0x1u) << 14
	     | ((uint32_t)word->raster & 0x1u) << 13
	     | ((uint32_t)word->tick_log2 & 0x1Fu) << 8
	     | ((uint32_t)word->axes & 0xFu) << 4
	     | ((uint32_t)word->channels & 0xFu);
}

static inline struct passo_parameters_word passo_unpack_parameters(uint32_t word)
{
	return (struct passo_parameters_word){
	    .outputs = (word >> 31 & 0x1u) != 0u,
	    .encoders = (word >> 30 & 0x1u) != 0u,
	    .inputs = (word >> 29 & 0x1u) != 0u,
	    .ramp_queue_log2 = (uint8_t)(word >> 24 & 0x1Fu),
	    .tracked = (uint8_t)(word >> 21 & 0x7u),
	    .line_queue_log2 = (uint8_t)(word >> 16 & 0x1Fu),
	    .trackers = (word >> 15 & 0x1u) != 0u,
	    .compare = (word >> 14 & 0x1u) != 0u,
	    .raster = (word >> 13 & 0x1u) != 0u,
	    .tick_log2 = (uint8_t)(word >> 8 & 0x1Fu),
	    .axes = (uint8_t)(word >> 4 & 0xFu),
	    .channels = (uint8_t)(word & 0xFu),
	};
}

/* Run. One bit per channel, all in one register: channels that are ARMED start on the same clock when one write clears their WAIT_SYNC. */
struct passo_run {
	uint8_t status_channel; /* Channel whose queue room the status word reports. */
	uint8_t wait_sync;      /* A prepared motion stays ARMED until a rising edge of the sync input, or until this bit is cleared. */
	uint8_t run;            /* The channel may start motions. Clearing it lets a running motion finish. */
};

static inline uint32_t passo_pack_run(const struct passo_run *word)
{
	return ((uint32_t)word->status_channel & 0x7u) << 16
	     | ((uint32_t)word->wait_sync & 0xFFu) << 8
	     | ((uint32_t)word->run & 0xFFu);
}

static inline struct passo_run passo_unpack_run(uint32_t word)
{
	return (struct passo_run){
	    .status_channel = (uint8_t)(word >> 16 & 0x7u),
	    .wait_sync = (uint8_t)(word >> 8 & 0xFFu),
	    .run = (uint8_t)(word & 0xFFu),
	};
}

/* Refusals 0. Counters of refused frames; they wrap. */
struct passo_refusals_0 {
	uint8_t unknown_address; /* UNKNOWN_ADDRESS. */
	uint8_t bad_operation;   /* BAD_OPERATION. */
	uint8_t bad_length;      /* BAD_LENGTH. */
	uint8_t bad_crc;         /* BAD_CRC. */
};

static inline uint32_t passo_pack_refusals_0(const struct passo_refusals_0 *word)
{
	return ((uint32_t)word->unknown_address & 0xFFu) << 24
	     | ((uint32_t)word->bad_operation & 0xFFu) << 16
	     | ((uint32_t)word->bad_length & 0xFFu) << 8
	     | ((uint32_t)word->bad_crc & 0xFFu);
}

static inline struct passo_refusals_0 passo_unpack_refusals_0(uint32_t word)
{
	return (struct passo_refusals_0){
	    .unknown_address = (uint8_t)(word >> 24 & 0xFFu),
	    .bad_operation = (uint8_t)(word >> 16 & 0xFFu),
	    .bad_length = (uint8_t)(word >> 8 & 0xFFu),
	    .bad_crc = (uint8_t)(word & 0xFFu),
	};
}

/* Refusals 1. Counters of refused frames; they wrap. */
struct passo_refusals_1 {
	uint8_t bad_value;  /* BAD_VALUE. */
	uint8_t busy;       /* BUSY. */
	uint8_t queue_full; /* QUEUE_FULL. */
	uint8_t read_only;  /* READ_ONLY. */
};

static inline uint32_t passo_pack_refusals_1(const struct passo_refusals_1 *word)
{
	return ((uint32_t)word->bad_value & 0xFFu) << 24
	     | ((uint32_t)word->busy & 0xFFu) << 16
	     | ((uint32_t)word->queue_full & 0xFFu) << 8
	     | ((uint32_t)word->read_only & 0xFFu);
}

static inline struct passo_refusals_1 passo_unpack_refusals_1(uint32_t word)
{
	return (struct passo_refusals_1){
	    .bad_value = (uint8_t)(word >> 24 & 0xFFu),
	    .busy = (uint8_t)(word >> 16 & 0xFFu),
	    .queue_full = (uint8_t)(word >> 8 & 0xFFu),
	    .read_only = (uint8_t)(word & 0xFFu),
	};
}

/* Watchdog. Stops motions when no frame has been executed for some time. In units of 2^16 clocks. */
struct passo_watchdog {
	uint16_t disable_after; /* Time from that stop until all drive enables are cleared; 0 = never. */
	uint16_t stop_after;    /* Silence after which a running motion is stopped softly; 0 = off. */
};

static inline uint32_t passo_pack_watchdog(const struct passo_watchdog *word)
{
	return ((uint32_t)word->disable_after & 0x3FFu) << 10
	     | ((uint32_t)word->stop_after & 0x3FFu);
}

static inline struct passo_watchdog passo_unpack_watchdog(uint32_t word)
{
	return (struct passo_watchdog){
	    .disable_after = (uint16_t)(word >> 10 & 0x3FFu),
	    .stop_after = (uint16_t)(word & 0x3FFu),
	};
}

/* Command. Each bit written as 1 takes effect once. STOP and ABORT override CLEAR and ZERO in the same word; ABORT has priority over STOP. */
struct passo_channel_command {
	bool zero;  /* Set the positions of the channel's axes to 0. */
	bool clear; /* Clear cause and lost steps and leave STOPPED. */
	bool abort; /* Hard stop: STOPPED immediately, waiting steps dropped, no new pulse begins. */
	bool stop;  /* Soft stop: rate to 0 by STOP_SLEW, then STOPPED. In IDLE, PREPARE and ARMED: STOPPED immediately. */
};

static inline uint32_t passo_pack_channel_command(const struct passo_channel_command *word)
{
	return ((uint32_t)word->zero & 0x1u) << 3
	     | ((uint32_t)word->clear & 0x1u) << 2
	     | ((uint32_t)word->abort & 0x1u) << 1
	     | ((uint32_t)word->stop & 0x1u);
}

static inline struct passo_channel_command passo_unpack_channel_command(uint32_t word)
{
	return (struct passo_channel_command){
	    .zero = (word >> 3 & 0x1u) != 0u,
	    .clear = (word >> 2 & 0x1u) != 0u,
	    .abort = (word >> 1 & 0x1u) != 0u,
	    .stop = (word & 0x1u) != 0u,
	};
}

/* State. State of the channel. */
struct passo_channel_state {
	uint16_t         drained;  /* Substeps drained since reset; wraps. */
	bool             stopping; /* A soft stop is in progress. */
	uint8_t          overrun;  /* One bit per axis: it had a STEP_OVERRUN. */
	enum passo_cause cause;    /* Cause of the stop. */
	bool             quiet;    /* Quiet: no motion is prepared or running, and the pins of every axis are idle. */
	enum passo_state state;    /* State of the motion. */
};

static inline uint32_t passo_pack_channel_state(const struct passo_channel_state *word)
{
	return ((uint32_t)word->drained & 0x7FFFu) << 17
	     | ((uint32_t)word->stopping & 0x1u) << 16
	     | ((uint32_t)word->overrun & 0xFFu) << 8
	     | ((uint32_t)word->cause & 0xFu) << 4
	     | ((uint32_t)word->quiet & 0x1u) << 3
	     | ((uint32_t)word->state & 0x7u);
}

static inline struct passo_channel_state passo_unpack_channel_state(uint32_t word)
{
	return (struct passo_channel_state){
	    .drained = (uint16_t)(word >> 17 & 0x7FFFu),
	    .stopping = (word >> 16 & 0x1u) != 0u,
	    .overrun = (uint8_t)(word >> 8 & 0xFFu),
	    .cause = (enum passo_cause)(word >> 4 & 0xFu),
	    .quiet = (word >> 3 & 0x1u) != 0u,
	    .state = (enum passo_state)(word & 0x7u),
	};
}

/* Room. Free places in the queues. A push counts from the moment its frame is accepted. */
struct passo_channel_room {
	uint16_t line_room; /* Lines. */
	uint16_t ramp_room; /* Ramps. */
};

static inline uint32_t passo_pack_channel_room(const struct passo_channel_room *word)
{
	return ((uint32_t)word->line_room & 0xFFFFu) << 16
	     | ((uint32_t)word->ramp_room & 0xFFFFu);
}

static inline struct passo_channel_room passo_unpack_channel_room(uint32_t word)
{
	return (struct passo_channel_room){
	    .line_room = (uint16_t)(word >> 16 & 0xFFFFu),
	    .ramp_room = (uint16_t)(word & 0xFFFFu),
	};
}

/* Input levels. Filtered levels, 1 = active, one bit per axis. */
struct passo_channel_input_levels {
	uint8_t alarm;      /* alarm. */
	uint8_t home;       /* home. */
	uint8_t limit_high; /* limit_high. */
	uint8_t limit_low;  /* limit_low. */
};

static inline uint32_t passo_pack_channel_input_levels(const struct passo_channel_input_levels *word)
{
	return ((uint32_t)word->alarm & 0xFFu) << 24
	     | ((uint32_t)word->home & 0xFFu) << 16
	     | ((uint32_t)word->limit_high & 0xFFu) << 8
	     | ((uint32_t)word->limit_low & 0xFFu);
}

static inline struct passo_channel_input_levels passo_unpack_channel_input_levels(uint32_t word)
{
	return (struct passo_channel_input_levels){
	    .alarm = (uint8_t)(word >> 24 & 0xFFu),
	    .home = (uint8_t)(word >> 16 & 0xFFu),
	    .limit_high = (uint8_t)(word >> 8 & 0xFFu),
	    .limit_low = (uint8_t)(word & 0xFFu),
	};
}

/* Input flags. Inputs that were active since their flag was cleared, one bit per axis. */
struct passo_channel_input_flags {
	uint8_t alarm;      /* alarm. */
	uint8_t home;       /* home. */
	uint8_t limit_high; /* limit_high. */
	uint8_t limit_low;  /* limit_low. */
};

static inline uint32_t passo_pack_channel_input_flags(const struct passo_channel_input_flags *word)
{
	return ((uint32_t)word->alarm & 0xFFu) << 24
	     | ((uint32_t)word->home & 0xFFu) << 16
	     | ((uint32_t)word->limit_high & 0xFFu) << 8
	     | ((uint32_t)word->limit_low & 0xFFu);
}

static inline struct passo_channel_input_flags passo_unpack_channel_input_flags(uint32_t word)
{
	return (struct passo_channel_input_flags){
	    .alarm = (uint8_t)(word >> 24 & 0xFFu),
	    .home = (uint8_t)(word >> 16 & 0xFFu),
	    .limit_high = (uint8_t)(word >> 8 & 0xFFu),
	    .limit_low = (uint8_t)(word & 0xFFu),
	};
}

/* Clear input flags. Each bit written as 1 clears a flag of INPUT_FLAGS; bits of axes that the core lacks do nothing. */
struct passo_channel_input_clear {
	uint8_t alarm;      /* alarm. */
	uint8_t home;       /* home. */
	uint8_t limit_high; /* limit_high. */
	uint8_t limit_low;  /* limit_low. */
};

static inline uint32_t passo_pack_channel_input_clear(const struct passo_channel_input_clear *word)
{
	return ((uint32_t)word->alarm & 0xFFu) << 24
	     | ((uint32_t)word->home & 0xFFu) << 16
	     | ((uint32_t)word->limit_high & 0xFFu) << 8
	     | ((uint32_t)word->limit_low & 0xFFu);
}

static inline struct passo_channel_input_clear passo_unpack_channel_input_clear(uint32_t word)
{
	return (struct passo_channel_input_clear){
	    .alarm = (uint8_t)(word >> 24 & 0xFFu),
	    .home = (uint8_t)(word >> 16 & 0xFFu),
	    .limit_high = (uint8_t)(word >> 8 & 0xFFu),
	    .limit_low = (uint8_t)(word & 0xFFu),
	};
}

/* Trigger. Every write ends what was armed before. */
struct passo_channel_trigger {
	bool                      arm;     /* 1: armed, once. */
	enum passo_trigger_action action;  /* What it does. */
	bool                      falling; /* 1: fires when the source becomes inactive; 0: active. */
	uint8_t                   axis;    /* Axis of the source. */
	enum passo_trigger_source source;  /* What fires it. */
};

static inline uint32_t passo_pack_channel_trigger(const struct passo_channel_trigger *word)
{
	return ((uint32_t)word->arm & 0x1u) << 16
	     | ((uint32_t)word->action & 0x3u) << 12
	     | ((uint32_t)word->falling & 0x1u) << 8
	     | ((uint32_t)word->axis & 0x7u) << 4
	     | ((uint32_t)word->source & 0x7u);
}

static inline struct passo_channel_trigger passo_unpack_channel_trigger(uint32_t word)
{
	return (struct passo_channel_trigger){
	    .arm = (word >> 16 & 0x1u) != 0u,
	    .action = (enum passo_trigger_action)(word >> 12 & 0x3u),
	    .falling = (word >> 8 & 0x1u) != 0u,
	    .axis = (uint8_t)(word >> 4 & 0x7u),
	    .source = (enum passo_trigger_source)(word & 0x7u),
	};
}

/* Trigger state. State of the trigger and the probe, and the axes that stopped the channel. */
struct passo_channel_trigger_state {
	uint8_t axes;          /* Axes of the first limit or alarm since COMMAND.CLEAR. */
	bool    unknown;       /* Levels of the inputs are unknown: they have not been stable for a period of the filter since the reset, or since polarity or filter were written. No motion begins. */
	bool    source_active; /* The trigger is armed, and its source is active. */
	bool    arming;        /* The trigger is being armed: its source has not kept one level for longer than the filter yet. No motion begins. */
	bool    probe_flag;    /* The probe was active since its flag was cleared. */
	bool    probe;         /* Filtered level of the probe, 1 = active. */
	bool    fired;         /* It has fired since it was armed. */
	bool    armed;         /* The trigger waits for its edge. */
};

static inline uint32_t passo_pack_channel_trigger_state(const struct passo_channel_trigger_state *word)
{
	return ((uint32_t)word->axes & 0xFFu) << 8
	     | ((uint32_t)word->unknown & 0x1u) << 6
	     | ((uint32_t)word->source_active & 0x1u) << 5
	     | ((uint32_t)word->arming & 0x1u) << 4
	     | ((uint32_t)word->probe_flag & 0x1u) << 3
	     | ((uint32_t)word->probe & 0x1u) << 2
	     | ((uint32_t)word->fired & 0x1u) << 1
	     | ((uint32_t)word->armed & 0x1u);
}

static inline struct passo_channel_trigger_state passo_unpack_channel_trigger_state(uint32_t word)
{
	return (struct passo_channel_trigger_state){
	    .axes = (uint8_t)(word >> 8 & 0xFFu),
	    .unknown = (word >> 6 & 0x1u) != 0u,
	    .source_active = (word >> 5 & 0x1u) != 0u,
	    .arming = (word >> 4 & 0x1u) != 0u,
	    .probe_flag = (word >> 3 & 0x1u) != 0u,
	    .probe = (word >> 2 & 0x1u) != 0u,
	    .fired = (word >> 1 & 0x1u) != 0u,
	    .armed = (word & 0x1u) != 0u,
	};
}

/* Probe. Polarity, after a change of which the inputs are unknown; and the flag of the probe. */
struct passo_channel_probe {
	bool clear;    /* 1: clear the flag. */
	bool inverted; /* 1: probe is active low. */
};

static inline uint32_t passo_pack_channel_probe(const struct passo_channel_probe *word)
{
	return ((uint32_t)word->clear & 0x1u) << 1
	     | ((uint32_t)word->inverted & 0x1u);
}

static inline struct passo_channel_probe passo_unpack_channel_probe(uint32_t word)
{
	return (struct passo_channel_probe){
	    .clear = (word >> 1 & 0x1u) != 0u,
	    .inverted = (word & 0x1u) != 0u,
	};
}

/* Compare pulse. Ends a pulse in progress, as COMPARE_DISTANCE does. */
struct passo_channel_compare_pulse {
	uint8_t  axis;  /* Axis whose position is compared. */
	uint16_t width; /* Clocks; 0 = no pulses. */
};

static inline uint32_t passo_pack_channel_compare_pulse(const struct passo_channel_compare_pulse *word)
{
	return ((uint32_t)word->axis & 0x7u) << 16
	     | ((uint32_t)word->width & 0xFFFFu);
}

static inline struct passo_channel_compare_pulse passo_unpack_channel_compare_pulse(uint32_t word)
{
	return (struct passo_channel_compare_pulse){
	    .axis = (uint8_t)(word >> 16 & 0x7u),
	    .width = (uint16_t)(word & 0xFFFFu),
	};
}

/* Output state. State of the outputs. */
struct passo_channel_output_state {
	uint16_t raster_room;  /* Free words of the raster queue; 0 without RASTER. A push counts from the moment its frame is accepted. */
	bool     overflow;     /* More than 256 changes waited for the lag since COMMAND.CLEAR. One was lost, so there is no power until then. */
	bool     raster_empty; /* A raster line found no value since COMMAND.CLEAR: its power was 0. */
	uint8_t  levels;       /* Levels of the digital outputs. */
};

static inline uint32_t passo_pack_channel_output_state(const struct passo_channel_output_state *word)
{
	return ((uint32_t)word->raster_room & 0xFFFFu) << 16
	     | ((uint32_t)word->overflow & 0x1u) << 9
	     | ((uint32_t)word->raster_empty & 0x1u) << 8
	     | ((uint32_t)word->levels & 0xFFu);
}

static inline struct passo_channel_output_state passo_unpack_channel_output_state(uint32_t word)
{
	return (struct passo_channel_output_state){
	    .raster_room = (uint16_t)(word >> 16 & 0xFFFFu),
	    .overflow = (word >> 9 & 0x1u) != 0u,
	    .raster_empty = (word >> 8 & 0x1u) != 0u,
	    .levels = (uint8_t)(word & 0xFFu),
	};
}

/* Follow. Whether and how the profile follows an encoder. */
struct passo_channel_follow {
	uint8_t scale;      /* A count is 2^scale clocks of the profile. */
	uint8_t source;     /* Axis of the encoder. A missing encoder never counts. */
	bool    wait_index; /* 1: an ARMED motion waits for the index of that encoder. */
	bool    follow;     /* 1: the clocks of the profile are counts of an encoder. */
};

static inline uint32_t passo_pack_channel_follow(const struct passo_channel_follow *word)
{
	return ((uint32_t)word->scale & 0x7u) << 5
	     | ((uint32_t)word->source & 0x7u) << 2
	     | ((uint32_t)word->wait_index & 0x1u) << 1
	     | ((uint32_t)word->follow & 0x1u);
}

static inline struct passo_channel_follow passo_unpack_channel_follow(uint32_t word)
{
	return (struct passo_channel_follow){
	    .scale = (uint8_t)(word >> 5 & 0x7u),
	    .source = (uint8_t)(word >> 2 & 0x7u),
	    .wait_index = (word >> 1 & 0x1u) != 0u,
	    .follow = (word & 0x1u) != 0u,
	};
}

/* Follow state. Of the motion that runs; behind and lost, of the last one, until the next is prepared. */
struct passo_channel_follow_state {
	bool     lost;   /* The phase is lost: 2^22 or more were outstanding, or A and B of the encoder changed simultaneously. */
	bool     behind; /* Two counts or more were owed: the path was late. */
	uint32_t owed;   /* Clocks of the profile that are owed to the encoder, signed. */
};

static inline uint32_t passo_pack_channel_follow_state(const struct passo_channel_follow_state *word)
{
	return ((uint32_t)word->lost & 0x1u) << 25
	     | ((uint32_t)word->behind & 0x1u) << 24
	     | ((uint32_t)word->owed & 0xFFFFFFu);
}

static inline struct passo_channel_follow_state passo_unpack_channel_follow_state(uint32_t word)
{
	return (struct passo_channel_follow_state){
	    .lost = (word >> 25 & 0x1u) != 0u,
	    .behind = (word >> 24 & 0x1u) != 0u,
	    .owed = (uint32_t)(word & 0xFFFFFFu),
	};
}

/* Tracker state. One bit per axis. */
struct passo_channel_tracker_state {
	uint8_t at_target; /* It is at its target. */
	uint8_t moves;     /* It moves. */
	uint8_t enabled;   /* The tracker is enabled. */
};

static inline uint32_t passo_pack_channel_tracker_state(const struct passo_channel_tracker_state *word)
{
	return ((uint32_t)word->at_target & 0xFFu) << 16
	     | ((uint32_t)word->moves & 0xFFu) << 8
	     | ((uint32_t)word->enabled & 0xFFu);
}

static inline struct passo_channel_tracker_state passo_unpack_channel_tracker_state(uint32_t word)
{
	return (struct passo_channel_tracker_state){
	    .at_target = (uint8_t)(word >> 16 & 0xFFu),
	    .moves = (uint8_t)(word >> 8 & 0xFFu),
	    .enabled = (uint8_t)(word & 0xFFu),
	};
}

/* Pins. Polarities and step mode. From the write on, the next step waits for the low time, the DIR hold and the DIR setup. */
struct passo_axis_pins {
	bool both_edges;         /* 1: every edge of STEP is a step. */
	bool enable_inverted;    /* 1: EN is active low. After configuration: parameter ENABLE_RESET. */
	bool direction_inverted; /* 1: DIR is high for the positive direction. After configuration: parameter DIR_RESET. */
	bool step_inverted;      /* 1: STEP is active low. After configuration: parameter STEP_RESET. */
};

static inline uint32_t passo_pack_axis_pins(const struct passo_axis_pins *word)
{
	return ((uint32_t)word->both_edges & 0x1u) << 4
	     | ((uint32_t)word->enable_inverted & 0x1u) << 3
	     | ((uint32_t)word->direction_inverted & 0x1u) << 2
	     | ((uint32_t)word->step_inverted & 0x1u) << 1;
}

static inline struct passo_axis_pins passo_unpack_axis_pins(uint32_t word)
{
	return (struct passo_axis_pins){
	    .both_edges = (word >> 4 & 0x1u) != 0u,
	    .enable_inverted = (word >> 3 & 0x1u) != 0u,
	    .direction_inverted = (word >> 2 & 0x1u) != 0u,
	    .step_inverted = (word >> 1 & 0x1u) != 0u,
	};
}

/* STEP timing. Clocks, 1 .. 65535; 0 counts as 1. */
struct passo_axis_step_timing {
	uint16_t step_high; /* Time that STEP is active. */
	uint16_t step_low;  /* Minimum time that STEP is inactive. */
};

static inline uint32_t passo_pack_axis_step_timing(const struct passo_axis_step_timing *word)
{
	return ((uint32_t)word->step_high & 0xFFFFu) << 16
	     | ((uint32_t)word->step_low & 0xFFFFu);
}

static inline struct passo_axis_step_timing passo_unpack_axis_step_timing(uint32_t word)
{
	return (struct passo_axis_step_timing){
	    .step_high = (uint16_t)(word >> 16 & 0xFFFFu),
	    .step_low = (uint16_t)(word & 0xFFFFu),
	};
}

/* DIR timing. Clocks, 1 .. 65535; 0 counts as 1. */
struct passo_axis_dir_timing {
	uint16_t dir_setup; /* DIR change to the next active edge of STEP. */
	uint16_t dir_hold;  /* End of step_low to the next change of DIR. */
};

static inline uint32_t passo_pack_axis_dir_timing(const struct passo_axis_dir_timing *word)
{
	return ((uint32_t)word->dir_setup & 0xFFFFu) << 16
	     | ((uint32_t)word->dir_hold & 0xFFFFu);
}

static inline struct passo_axis_dir_timing passo_unpack_axis_dir_timing(uint32_t word)
{
	return (struct passo_axis_dir_timing){
	    .dir_setup = (uint16_t)(word >> 16 & 0xFFFFu),
	    .dir_hold = (uint16_t)(word & 0xFFFFu),
	};
}

/* Inputs of the axis. Polarities, and what limits and alarm do. After a write the inputs are unknown. */
struct passo_axis_inputs {
	bool alarm_disables;      /* 1: the alarm also clears the drive enable of this axis. */
	bool alarm_soft;          /* 1: the alarm makes a soft stop; 0: a hard one. */
	bool limit_soft;          /* 1: limits make a soft stop; 0: a hard one. */
	bool alarm_inverted;      /* 1: alarm is active low. */
	bool home_inverted;       /* 1: home is active low. */
	bool limit_high_inverted; /* 1: limit_high is active low. */
	bool limit_low_inverted;  /* 1: limit_low is active low. */
};

static inline uint32_t passo_pack_axis_inputs(const struct passo_axis_inputs *word)
{
	return ((uint32_t)word->alarm_disables & 0x1u) << 6
	     | ((uint32_t)word->alarm_soft & 0x1u) << 5
	     | ((uint32_t)word->limit_soft & 0x1u) << 4
	     | ((uint32_t)word->alarm_inverted & 0x1u) << 3
	     | ((uint32_t)word->home_inverted & 0x1u) << 2
	     | ((uint32_t)word->limit_high_inverted & 0x1u) << 1
	     | ((uint32_t)word->limit_low_inverted & 0x1u);
}

static inline struct passo_axis_inputs passo_unpack_axis_inputs(uint32_t word)
{
	return (struct passo_axis_inputs){
	    .alarm_disables = (word >> 6 & 0x1u) != 0u,
	    .alarm_soft = (word >> 5 & 0x1u) != 0u,
	    .limit_soft = (word >> 4 & 0x1u) != 0u,
	    .alarm_inverted = (word >> 3 & 0x1u) != 0u,
	    .home_inverted = (word >> 2 & 0x1u) != 0u,
	    .limit_high_inverted = (word >> 1 & 0x1u) != 0u,
	    .limit_low_inverted = (word & 0x1u) != 0u,
	};
}

/* Encoder setup. How the encoder counts, and what a following error does. */
struct passo_encoder_setup {
	bool stop_hard;      /* 1: it is a hard stop, whatever stop_soft says. Neither: it only shows. */
	bool stop_soft;      /* 1: a following error at the limit is a soft stop. */
	bool index_gated;    /* 1: the index counts only while A and B are high. */
	bool index_inverted; /* 1: the index is active low. */
	bool inverted;       /* 1: up is B before A. */
};

static inline uint32_t passo_pack_encoder_setup(const struct passo_encoder_setup *word)
{
	return ((uint32_t)word->stop_hard & 0x1u) << 4
	     | ((uint32_t)word->stop_soft & 0x1u) << 3
	     | ((uint32_t)word->index_gated & 0x1u) << 2
	     | ((uint32_t)word->index_inverted & 0x1u) << 1
	     | ((uint32_t)word->inverted & 0x1u);
}

static inline struct passo_encoder_setup passo_unpack_encoder_setup(uint32_t word)
{
	return (struct passo_encoder_setup){
	    .stop_hard = (word >> 4 & 0x1u) != 0u,
	    .stop_soft = (word >> 3 & 0x1u) != 0u,
	    .index_gated = (word >> 2 & 0x1u) != 0u,
	    .index_inverted = (word >> 1 & 0x1u) != 0u,
	    .inverted = (word & 0x1u) != 0u,
	};
}

/* Greatest following error. Since COMMAND.ZERO, COMMAND.CLEAR or a write of the ratio. */
struct passo_encoder_greatest {
	bool     exceeded; /* The error is at its limit now. */
	uint32_t greatest; /* Counts, either way. */
};

static inline uint32_t passo_pack_encoder_greatest(const struct passo_encoder_greatest *word)
{
	return ((uint32_t)word->exceeded & 0x1u) << 31
	     | ((uint32_t)word->greatest & 0x3FFFFu);
}

static inline struct passo_encoder_greatest passo_unpack_encoder_greatest(uint32_t word)
{
	return (struct passo_encoder_greatest){
	    .exceeded = (word >> 31 & 0x1u) != 0u,
	    .greatest = (uint32_t)(word & 0x3FFFFu),
	};
}

/* Encoder index. What the index has latched, and the transitions that were none. All 0 after COMMAND.ZERO. */
struct passo_encoder_index {
	uint8_t  illegal; /* Simultaneous changes of A and B (illegal transitions), saturating at 255; also cleared by COMMAND.CLEAR. */
	uint8_t  indexes; /* Number of indexes; wraps. */
	uint16_t latch;   /* Encoder position at the last index, its lower 16 bits. */
};

static inline uint32_t passo_pack_encoder_index(const struct passo_encoder_index *word)
{
	return ((uint32_t)word->illegal & 0xFFu) << 24
	     | ((uint32_t)word->indexes & 0xFFu) << 16
	     | ((uint32_t)word->latch & 0xFFFFu);
}

static inline struct passo_encoder_index passo_unpack_encoder_index(uint32_t word)
{
	return (struct passo_encoder_index){
	    .illegal = (uint8_t)(word >> 24 & 0xFFu),
	    .indexes = (uint8_t)(word >> 16 & 0xFFu),
	    .latch = (uint16_t)(word & 0xFFFFu),
	};
}

#endif
