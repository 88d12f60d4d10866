// SPDX-License-Identifier: MIT
// Makes one move of two axes behind SPI and counts its pulses. Says "passed", or "FAILED" and why.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_bench;

  `include "passo_registers.vh"

  localparam [31:0] SUBSTEPS = 160, STEPS_0 = 40, STEPS_1 = 10, TICKS = 20;
  localparam [31:0] VELOCITY_HIGH = 32'h1000_0000;  // 1/16 substep per clock: 8 in a tick of 128 clocks
  localparam [31:0] MOTION = TICKS * 128;  // clocks
  localparam [31:0] LINE_LAST = 1 << LINE_CONTROL_LAST_LSB;
  localparam [31:0] LINE_NEGATIVE_1 = 2 << LINE_CONTROL_DIRECTIONS_LSB;
  localparam [31:0] RAMP_LAST = 1 << RAMP_CONTROL_LAST_LSB;

  reg  clk = 1'b0;
  reg  rst = 1'b1;
  reg  spi_sclk = 1'b0;
  reg  spi_mosi = 1'b0;
  reg  spi_cs_n = 1'b0;  // falls before it rises: an edge resets the part on SCLK
  wire spi_miso;
  wire [1:0] step, dir, enable;
  wire running;
  wire irq;

  passo_spi_top #(
    .AXES(2)
  ) u_core (
    .clk            (clk),
    .rst            (rst),
    .spi_sclk       (spi_sclk),
    .spi_mosi       (spi_mosi),
    .spi_cs_n       (spi_cs_n),
    .spi_miso       (spi_miso),
    .spi_miso_enable(),
    .sync           (1'b0),
    .limit_low      (2'b00),
    .limit_high     (2'b00),
    .home           (2'b00),
    .alarm          (2'b00),
    .probe          (1'b0),
    .estop_n        (1'b1),
    .encoder_a      (2'b00),
    .encoder_b      (2'b00),
    .encoder_index  (2'b00),
    .step           (step),
    .dir            (dir),
    .enable         (enable),
    .outputs        (),
    .power          (),
    .compare        (),
    .running        (running),
    .irq            (irq)
  );

  always #5 clk = ~clk;

  // What is seen at the pins
  reg [31:0] pulses_0 = 0, pulses_1 = 0, wrong_way = 0, moving = 0;
  reg [1:0] step_q = 2'd0;

  always @(negedge clk) begin
    step_q <= step;
    if (step[0] && !step_q[0]) pulses_0 = pulses_0 + 1;
    if (step[1] && !step_q[1]) pulses_1 = pulses_1 + 1;
    if ((step[0] && dir[0]) || (step[1] && !dir[1])) wrong_way = wrong_way + 1;
    if (running) moving = moving + 1;
  end

  // One frame: `words` has the payload, the reply goes to `reply`
  reg [31:0] words[0:15];
  reg [31:0] reply, crc;
  reg [7:0] sequence_number = 8'd0;
  reg       failed = 1'b0;

  task exchange(input [31:0] word);
    integer i, bit_number;
    begin
      for (i = 31; i >= 0; i = i - 1) begin
        spi_mosi = word[i];
        repeat (2) @(negedge clk);
        reply    = {reply[30:0], spi_miso};
        spi_sclk = 1'b1;
        repeat (2) @(negedge clk);
        spi_sclk = 1'b0;
      end
      for (bit_number = 31; bit_number >= 0; bit_number = bit_number - 1)
      crc = {crc[30:0], 1'b0} ^ (crc[31] ^ word[bit_number] ? 32'h04C1_1DB7 : 32'd0);
    end
  endtask

  task begin_frame(input [3:0] operation, input [11:0] address, input [7:0] count);
    begin
      sequence_number = sequence_number + 8'd1;
      crc             = 32'hFFFF_FFFF;
      spi_cs_n        = 1'b0;
      repeat (4) @(negedge clk);
      exchange({operation, sequence_number, count, address});
    end
  endtask

  task end_frame;
    begin
      repeat (4) @(negedge clk);
      spi_cs_n = 1'b1;
      repeat (64) @(negedge clk);
    end
  endtask

  task send(input [3:0] operation, input [11:0] address, input [7:0] count);
    integer k;
    begin
      begin_frame(operation, address, count);
      for (k = 0; k < count; k = k + 1) exchange(words[k]);
      exchange(crc);
      exchange(32'd0);
      exchange(32'd0);
      end_frame;
      if (reply != {sequence_number, 4'd0, VERDICT_OK, ~sequence_number, 4'hF, ~VERDICT_OK}) begin
        $display("FAILED: the reply to a frame for 0x%h is %h", address, reply);
        failed = 1'b1;
      end
    end
  endtask

  task expect_read(input [11:0] address, input [31:0] expected);
    begin
      begin_frame(OPERATION_READ, address, 8'd1);
      exchange(crc);
      exchange(32'd0);
      exchange(32'd0);
      if (reply != expected) begin
        $display("FAILED: 0x%h holds %h, not %h", address, reply, expected);
        failed = 1'b1;
      end
      exchange(32'd0);
      end_frame;
    end
  endtask

  task expect_count(input [31:0] actual, input [31:0] expected);
    if (actual != expected) begin
      $display("FAILED: counted %0d, not %0d", actual, expected);
      failed = 1'b1;
    end
  endtask

  function [11:0] of_channel(input [7:0] offset);
    of_channel = ADDRESS_CHANNEL_BASE + {4'd0, offset};
  endfunction

  initial begin
    repeat (8) @(negedge clk);
    spi_cs_n = 1'b1;
    repeat (8) @(negedge clk);
    rst = 1'b0;
    repeat (8) @(negedge clk);
    expect_read(ADDRESS_IDENTIFICATION, IDENTIFICATION_RESET);
    words[0] = LINE_LAST | LINE_NEGATIVE_1;
    words[1] = SUBSTEPS;
    words[2] = STEPS_0;
    words[3] = STEPS_1;
    send(OPERATION_PUSH, of_channel(CHANNEL_LINE), 8'd4);
    // to the velocity immediately, along, to 0 immediately
    words[0]  = VELOCITY_HIGH;
    words[1]  = 32'd0;
    words[2]  = 32'd0;
    words[3]  = 32'd0;
    words[4]  = 32'd0;
    words[5]  = VELOCITY_HIGH;
    words[6]  = 32'd0;
    words[7]  = TICKS;
    words[8]  = 32'd0;
    words[9]  = 32'd1;
    words[10] = RAMP_LAST;
    words[11] = 32'd0;
    words[12] = 32'd0;
    words[13] = 32'd0;
    words[14] = 32'd0;
    send(OPERATION_PUSH, of_channel(CHANNEL_RAMP), 8'd15);
    words[0] = 32'd1 << RUN_RUN_LSB;
    send(OPERATION_WRITE, ADDRESS_RUN, 8'd1);
    repeat (MOTION + 1000) @(negedge clk);
    expect_count(pulses_0, STEPS_0);
    expect_count(pulses_1, STEPS_1);
    expect_count(wrong_way, 0);
    expect_count(moving, MOTION);
    expect_count({30'd0, enable}, 0);
    expect_count({31'd0, irq}, 0);
    expect_read(of_channel(CHANNEL_POSITION_BASE), STEPS_0);
    expect_read(of_channel(CHANNEL_POSITION_BASE + 8'd1), -STEPS_1);
    if (!failed) $display("passed: %0d and %0d steps in %0d clocks", pulses_0, pulses_1, moving);
    $finish;
  end

endmodule
`resetall
