// SPDX-License-Identifier: MIT
// Recorder of the pins of the core.
//
// Clock 1 is the first rising edge ever without rst. Whenever a pin is not as it was a clock before, a row goes to pins.log:
//
//   clock; rst, sclk, mosi, cs_n, sync as bits 4 .. 0 and miso, all as they stand at its rising edge;
//   step, dir, enable, running, irq as the rising edge before left them
//
// in decimal numbers; one with an X in it is not a number.

localparam PINS = 6 + 3 * CHANNELS * AXES + CHANNELS + 1;

wire    [PINS-1:0] pins = {rst, spi_sclk, spi_mosi, spi_cs_n, sync, spi_miso, step, dir, enable, running, irq};
reg     [PINS-1:0] pins_before;
reg                begun = 1'b0;
reg     [    31:0] clock = 0;
integer            file;

initial file = $fopen("pins.log", "w");

always @(posedge clk) begin
  pins_before <= pins;
  if (begun || rst === 1'b0) begin
    begun <= 1'b1;
    clock <= clock + 1;
    if (!begun || pins !== pins_before) begin
      $fwrite(file, "%0d %0d %0d %0d %0d %0d %0d %0d\n", clock + 1,
              {rst, spi_sclk, spi_mosi, spi_cs_n, sync}, spi_miso, step, dir, enable, running, irq);
      $fflush(file);
    end
  end
end
