/* SPDX-License-Identifier: MIT
 * The console: a text interface to a Passo core. docs/console.md describes the commands.
 *
 * Every input line is answered by one line that starts with `ok` or `error:`; before it, `help` prints lines
 * that start with two spaces. Lines that start with `note:` are unsolicited. A move that finds the queues
 * full is answered when it is queued or can no longer be; home and probe when they have ended; wait_trigger
 * when the trigger has fired. Meanwhile only some commands are accepted. Portable: the board, or a
 * simulation, provides the hardware functions of the link and a text output.
 */
#ifndef PASSO_CONSOLE_H
#define PASSO_CONSOLE_H

#include "passo.h"
#include "passo_encoder.h"
#include "passo_forms.h"
#include "passo_home.h"
#include "passo_outputs.h"
#include "passo_track.h"

/* Maximum length of a line, without its terminator. */
#define PASSO_LINE_MAX 255u

/* Stands for a byte that was lost or received with an error; its line is rejected. */
#define PASSO_CONSOLE_LOST '\0'

/* Clock that times are read with until a core tells its own, or `config clock_hz=` sets it. */
#define PASSO_CLOCK_HZ_RESET 100000000u

/* Functions of the board; unused ones are null. */
struct passo_console_board {
	/* Called after the answer has been sent. */
	void (*set_baud)(void *context, uint32_t baud);
	void (*set_spi_fast)(void *context, bool fast);
	uint32_t spi_fast_hz; /* clock of the core from which it can be fast */
	/* Number of receive overruns of the serial line. */
	uint32_t (*lost_bytes)(void *context);
	void (*leave)(void); /* for what else is in the image */
	void *context;
};

/* Inputs of an axis; enum passo_level. */
struct passo_console_inputs {
	uint8_t limit_low, limit_high, home, alarm;
	bool limit_soft, alarm_soft, alarm_disables;
};

#ifndef PASSO_WITHOUT_PARTS
/* Encoder of an axis. */
struct passo_console_encoder {
	uint64_t counts_per_step; /* UQ32.32 */
	uint64_t limit;           /* of the following error, UQ32.32 steps; PASSO_NO_FOLLOWING_LIMIT */
	uint8_t stop;             /* enum passo_following_stop, at the limit */
	bool inverted, index_inverted, index_gated;
};
#define PASSO_NO_FOLLOWING_LIMIT UINT64_MAX
#endif

#ifndef PASSO_WITHOUT_TRACKERS
/* Tracker of an axis. */
struct passo_console_tracker {
	uint64_t speed, acceleration; /* UQ32.32 steps/s, steps/s^2; speed 0: not configured */
	uint32_t backlash;            /* steps */
};
#endif

/* Reasons why a line waits before it is answered. */
enum passo_awaited {
	PASSO_AWAITS_NOTHING,
	PASSO_AWAITS_ROOM, /* a move, for free queue entries */
	PASSO_AWAITS_HOME, /* its end */
	PASSO_AWAITS_PROBE,
	PASSO_AWAITS_TRIGGER
};

/* A channel of the core. */
struct passo_console_channel {
	struct passo passo;
	enum passo_error noted; /* current error, reported in a note */
	uint32_t looked_at;     /* microseconds: time of the last poll */
	bool unset;             /* settings not applied yet: it was moving when opened */
	uint8_t enabled;        /* bit i: axis i was enabled */
	uint8_t announced;      /* bit i: a note said that axis i is not enabled */
	struct passo_axis_config axis[PASSO_AXES_MAX]; /* times in clocks */
	struct passo_console_inputs inputs[PASSO_AXES_MAX];
	uint8_t inputs_given; /* bit i: those of axis i were configured */
	uint8_t probe;        /* enum passo_level */
	struct passo_home home;
#ifndef PASSO_WITHOUT_PARTS
	struct passo_outputs_config outputs;
	uint8_t levels; /* of the digital outputs, unless a move has its own */
	struct passo_console_encoder encoder[PASSO_AXES_MAX];
	uint8_t encoders_given;  /* bit i: that of axis i was configured */
	uint32_t encoder_filter; /* clocks */
	struct passo_encoder_reading encoder_readings[PASSO_AXES_MAX]; /* the last ones */
#endif
#ifndef PASSO_WITHOUT_TRACKERS
	struct passo_console_tracker tracker[PASSO_AXES_MAX];
#endif
};

struct passo_console {
	struct passo_sink sink;
	struct passo_hardware hardware;
	struct passo_console_board board;
	struct passo_host host;
	struct passo_console_channel channel[PASSO_CHANNELS_MAX];
	uint32_t clock_hz, hold_microseconds, stop_microseconds, baud;
	uint32_t given_hz; /* the clock that the core must have; 0: what it tells */
	uint32_t tried_at; /* microseconds: time of the last attempt to open the core */
	uint32_t filter_microseconds, watchdog_microseconds, disable_microseconds; /* of the inputs */
	bool spi_slow;
	bool opened;
	enum passo_error absent; /* why it is not open */
	struct passo_loaded_table table;
	bool need_enable; /* moves of axes that are not enabled are rejected */
	/* flow control */
	bool flow_waits;          /* moves wait for free queue entries; otherwise they are rejected */
	enum passo_awaited waits; /* what the current line waits for */
	char waiting[PASSO_LINE_MAX + 1u]; /* the line */
	uint8_t waiting_channel;
	uint32_t waits_since, waits_most; /* microseconds, for the trigger */
	uint8_t seen_moving;              /* bit i: channel i was moving at its last attempt */
	enum passo_state seen_state;      /* the same of its channel */
	uint16_t seen_lines, seen_ramps;
	/* the incomplete input line */
	char line[PASSO_LINE_MAX + 1u];
	uint16_t length;
	bool too_long, ended_by_return;
	uint16_t bad; /* first non-printable byte, plus 1; 0: none */
};

/* Initializes the console, prints a greeting and tries to open the core. `board` may be null; `clock_hz` is
 * the clock that the core must have, or 0, and `baud` the initial value. */
void passo_console_start(struct passo_console *console, const struct passo_sink *sink,
    const struct passo_hardware *hardware, const struct passo_console_board *board, uint32_t clock_hz,
    uint32_t baud);

/* Processes a byte of input. The end of a line executes and answers it. */
void passo_console_receive(struct passo_console *console, char byte);

/* Call it continuously, also after each line, or the watchdog of a core with inputs stops the motion; at most
 * one frame per call and channel, plus one while a line waits for the trigger. Reports an error in a
 * note, once while it persists. A core that did not respond at the start is retried twice a second. */
void passo_console_poll(struct passo_console *console);

/* True if no motion is running or queued, or if there is no core. */
bool passo_console_is_idle(const struct passo_console *console);

/* True if the channel of a waiting move, or else every moving channel, is held or waits for its start. */
bool passo_console_stands(const struct passo_console *console);

/* True while a line waits for its answer. */
bool passo_console_owes(const struct passo_console *console);

/* True if the core is open and has no fault. */
bool passo_console_is_well(const struct passo_console *console);

#endif
