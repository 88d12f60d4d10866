// SPDX-License-Identifier: MIT
// Recorder of the pins of the core. Generated from spec/pins.toml by spec/generate_pins.py.
//
// Clock 1 is the first rising edge ever without rst. Whenever a pin is not as it was a clock before, a row
// goes to pins.log: the clock; the inputs and MISO as they stand at its rising edge; the other outputs as the
// rising edge before left them. The numbers are decimal; one with an X in it is not a number.

localparam PINS = 1 + 1 + 1 + 1 + 1 + 1 + 1 + CHANNELS*AXES + CHANNELS*AXES + CHANNELS*AXES + CHANNELS*AXES + CHANNELS + CHANNELS*AXES + CHANNELS*AXES + CHANNELS*AXES + CHANNELS*AXES + CHANNELS*AXES + CHANNELS*AXES + CHANNELS + 1 + CHANNELS*8 + CHANNELS + CHANNELS;

wire [PINS-1:0] pins = {rst, spi_sclk, spi_mosi, spi_cs_n, sync, estop_n, limit_low, limit_high, home, alarm, probe, encoder_a, encoder_b, encoder_index, spi_miso, step, dir, enable, running, irq, outputs, power, compare};
reg  [PINS-1:0] pins_before;
reg             begun = 1'b0;
reg  [    31:0] clock = 0;
integer         file;

initial file = $fopen("pins.log", "w");

always @(posedge clk) begin
  pins_before <= pins;
  if (begun || rst === 1'b0) begin
    begun <= 1'b1;
    clock <= clock + 1;
    if (!begun || pins !== pins_before) begin
      $fwrite(file, "%0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d %0d\n", clock + 1, rst, spi_sclk, spi_mosi, spi_cs_n, sync, estop_n, limit_low, limit_high, home, alarm, probe, encoder_a, encoder_b, encoder_index, spi_miso, step, dir, enable, running, irq, outputs, power, compare);
      $fflush(file);
    end
  end
end
