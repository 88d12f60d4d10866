/* SPDX-License-Identifier: MIT
 * Parameters and pins of the core, and macros that do something for each of them.
 *
 * Generated from spec/pins.toml by spec/generate_pins.py. */
#ifndef PASSO_PINS_H
#define PASSO_PINS_H

#include <stdbool.h>
#include <stdint.h>

struct passo_parameters {
	uint8_t channels; /* CHANNELS, 1 .. 8 */
	uint8_t axes; /* AXES, 1 .. 8 */
	uint8_t tick_log2; /* TICK_LOG2, 7 .. 16 */
	uint8_t line_queue_log2; /* LINE_QUEUE_LOG2, 2 .. 8 */
	uint8_t ramp_queue_log2; /* RAMP_QUEUE_LOG2, 2 .. 8 */
	uint8_t inputs; /* INPUTS, 0 or 1: limits, home, alarm, probe, e-stop */
	uint8_t encoders; /* ENCODERS, 0 or 1 */
	uint8_t outputs; /* OUTPUTS, 0 or 1: outputs bound to the path */
	uint8_t raster; /* RASTER, 0 or 1, with OUTPUTS: raster lines, whose power comes from a queue */
	uint8_t compare; /* COMPARE, 0 or 1, with OUTPUTS: pulses at positions of an axis */
	uint8_t trackers; /* TRACKERS, 0 or 1: a second hand on every axis */
	uint8_t tracked; /* TRACKED, 0 .. AXES - 1: the last axes, which have no lines: only their trackers move them */
	uint32_t clock_hz; /* CLOCK_HZ, what the host reads as the clock, in Hz; 0: not told */
	uint32_t build; /* BUILD, what the host reads as the identifier of the bitstream */
	/* initial pin levels, bit channel * AXES + axis */
	uint64_t step_reset;
	uint64_t dir_reset;
	uint64_t enable_reset;
};

/* Input pins, with a bit per axis, channel * AXES + axis, or per channel. Each level of
 * spi_sclk must last at least one clock, and spi_cs_n must not change together with it. */
struct passo_inputs {
	bool rst;
	bool spi_sclk;
	bool spi_mosi;
	bool spi_cs_n;
	bool sync;
	bool estop_n;
	uint64_t limit_low;
	uint64_t limit_high;
	uint64_t home;
	uint64_t alarm;
	uint8_t probe;
	uint64_t encoder_a;
	uint64_t encoder_b;
	uint64_t encoder_index;
};

/* Output pins. `outputs` has 8 bits per channel. */
struct passo_outputs {
	uint64_t step;
	uint64_t dir;
	uint64_t enable;
	uint8_t running;
	bool irq;
	uint64_t outputs;
	uint8_t power;
	uint8_t compare;
	bool spi_miso;
};

/* Levels of the output pins, except MISO, after a clock; clock 1 is the first one after reset. */
struct passo_pin_event {
	uint64_t clock;
	uint64_t step;
	uint64_t dir;
	uint64_t enable;
	uint64_t running;
	uint64_t irq;
	uint64_t outputs;
	uint64_t power;
	uint64_t compare;
};

enum passo_input {
	PASSO_INPUT_RST,
	PASSO_INPUT_SPI_SCLK,
	PASSO_INPUT_SPI_MOSI,
	PASSO_INPUT_SPI_CS_N,
	PASSO_INPUT_SYNC,
	PASSO_INPUT_ESTOP_N,
	PASSO_INPUT_LIMIT_LOW,
	PASSO_INPUT_LIMIT_HIGH,
	PASSO_INPUT_HOME,
	PASSO_INPUT_ALARM,
	PASSO_INPUT_PROBE,
	PASSO_INPUT_ENCODER_A,
	PASSO_INPUT_ENCODER_B,
	PASSO_INPUT_ENCODER_INDEX,
	PASSO_INPUT_COUNT
};

#define PASSO_OUTPUT_COUNT 8u

/* Nothing is connected. */
#define PASSO_INPUTS_IDLE {.spi_cs_n = true, .estop_n = true}

/* X(name, Verilog name) */
#define PASSO_PARAMETERS(X) \
    X(channels, CHANNELS) \
    X(axes, AXES) \
    X(tick_log2, TICK_LOG2) \
    X(line_queue_log2, LINE_QUEUE_LOG2) \
    X(ramp_queue_log2, RAMP_QUEUE_LOG2) \
    X(inputs, INPUTS) \
    X(encoders, ENCODERS) \
    X(outputs, OUTPUTS) \
    X(raster, RASTER) \
    X(compare, COMPARE) \
    X(trackers, TRACKERS) \
    X(tracked, TRACKED) \
    X(clock_hz, CLOCK_HZ) \
    X(build, BUILD)

#define PASSO_LEVELS(X) \
    X(step_reset, STEP_RESET) \
    X(dir_reset, DIR_RESET) \
    X(enable_reset, ENABLE_RESET)

/* X(name, type, enumeration) */
#define PASSO_INPUTS(X) \
    X(rst, bool, PASSO_INPUT_RST) \
    X(spi_sclk, bool, PASSO_INPUT_SPI_SCLK) \
    X(spi_mosi, bool, PASSO_INPUT_SPI_MOSI) \
    X(spi_cs_n, bool, PASSO_INPUT_SPI_CS_N) \
    X(sync, bool, PASSO_INPUT_SYNC) \
    X(estop_n, bool, PASSO_INPUT_ESTOP_N) \
    X(limit_low, uint64_t, PASSO_INPUT_LIMIT_LOW) \
    X(limit_high, uint64_t, PASSO_INPUT_LIMIT_HIGH) \
    X(home, uint64_t, PASSO_INPUT_HOME) \
    X(alarm, uint64_t, PASSO_INPUT_ALARM) \
    X(probe, uint8_t, PASSO_INPUT_PROBE) \
    X(encoder_a, uint64_t, PASSO_INPUT_ENCODER_A) \
    X(encoder_b, uint64_t, PASSO_INPUT_ENCODER_B) \
    X(encoder_index, uint64_t, PASSO_INPUT_ENCODER_INDEX)

/* X(name, type, number), all but MISO */
#define PASSO_OUTPUTS(X) \
    X(step, uint64_t, 0u) \
    X(dir, uint64_t, 1u) \
    X(enable, uint64_t, 2u) \
    X(running, uint8_t, 3u) \
    X(irq, bool, 4u) \
    X(outputs, uint64_t, 5u) \
    X(power, uint8_t, 6u) \
    X(compare, uint8_t, 7u)

#define PASSO_SAME_INPUTS(a, b) \
    ((a)->rst == (b)->rst \
    && (a)->spi_sclk == (b)->spi_sclk \
    && (a)->spi_mosi == (b)->spi_mosi \
    && (a)->spi_cs_n == (b)->spi_cs_n \
    && (a)->sync == (b)->sync \
    && (a)->estop_n == (b)->estop_n \
    && (a)->limit_low == (b)->limit_low \
    && (a)->limit_high == (b)->limit_high \
    && (a)->home == (b)->home \
    && (a)->alarm == (b)->alarm \
    && (a)->probe == (b)->probe \
    && (a)->encoder_a == (b)->encoder_a \
    && (a)->encoder_b == (b)->encoder_b \
    && (a)->encoder_index == (b)->encoder_index)

#define PASSO_SAME_OUTPUTS(a, b) \
    ((a)->step == (b)->step \
    && (a)->dir == (b)->dir \
    && (a)->enable == (b)->enable \
    && (a)->running == (b)->running \
    && (a)->irq == (b)->irq \
    && (a)->outputs == (b)->outputs \
    && (a)->power == (b)->power \
    && (a)->compare == (b)->compare)

#endif
