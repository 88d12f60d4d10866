// SPDX-License-Identifier: MIT
// Pins of the core as 64 bits each, the first in the lowest bits. Generated from spec/pins.toml by spec/generate_pins.py.

localparam INPUT_COUNT = 14;
localparam OUTPUT_COUNT = 9;

reg rst = 1'b0;
reg spi_sclk = 1'b0;
reg spi_mosi = 1'b0;
reg spi_cs_n = 1'b1;
reg sync = 1'b0;
reg estop_n = 1'b1;
reg [CHANNELS*AXES-1:0] limit_low = {CHANNELS*AXES{1'b0}};
reg [CHANNELS*AXES-1:0] limit_high = {CHANNELS*AXES{1'b0}};
reg [CHANNELS*AXES-1:0] home = {CHANNELS*AXES{1'b0}};
reg [CHANNELS*AXES-1:0] alarm = {CHANNELS*AXES{1'b0}};
reg [CHANNELS-1:0] probe = {CHANNELS{1'b0}};
reg [CHANNELS*AXES-1:0] encoder_a = {CHANNELS*AXES{1'b0}};
reg [CHANNELS*AXES-1:0] encoder_b = {CHANNELS*AXES{1'b0}};
reg [CHANNELS*AXES-1:0] encoder_index = {CHANNELS*AXES{1'b0}};
wire [CHANNELS*AXES-1:0] step;
wire [CHANNELS*AXES-1:0] dir;
wire [CHANNELS*AXES-1:0] enable;
wire [CHANNELS-1:0] running;
wire irq;
wire [CHANNELS*8-1:0] outputs;
wire [CHANNELS-1:0] power;
wire [CHANNELS-1:0] compare;
wire spi_miso;

reg  [64*OUTPUT_COUNT-1:0] wanted;
wire [64*OUTPUT_COUNT-1:0] seen = {
  64'd0 | spi_miso,
  64'd0 | compare,
  64'd0 | power,
  64'd0 | outputs,
  64'd0 | irq,
  64'd0 | running,
  64'd0 | enable,
  64'd0 | dir,
  64'd0 | step
};

task set_inputs(input [64*INPUT_COUNT-1:0] levels);
  begin
    rst = levels[0+:64];
    spi_sclk = levels[64+:64];
    spi_mosi = levels[128+:64];
    spi_cs_n = levels[192+:64];
    sync = levels[256+:64];
    estop_n = levels[320+:64];
    limit_low = levels[384+:64];
    limit_high = levels[448+:64];
    home = levels[512+:64];
    alarm = levels[576+:64];
    probe = levels[640+:64];
    encoder_a = levels[704+:64];
    encoder_b = levels[768+:64];
    encoder_index = levels[832+:64];
  end
endtask

task tell_difference(input [31:0] clock);
  $display("clock %0d: step %h %h dir %h %h enable %h %h running %h %h irq %h %h outputs %h %h power %h %h compare %h %h spi_miso %h %h", clock, step, wanted[0+:64], dir, wanted[64+:64], enable, wanted[128+:64], running, wanted[192+:64], irq, wanted[256+:64], outputs, wanted[320+:64], power, wanted[384+:64], compare, wanted[448+:64], spi_miso, wanted[512+:64]);
endtask
