// SPDX-License-Identifier: MIT
// The core in a design of your own: three axes behind Wishbone, with limit switches and an e-stop.
//
// Drives with an active-low enable: EN is high, and so the drives are off, from configuration until the host
// enables them.
`timescale 1ns / 1ps

module motion_top (
  input  wire        clk,
  input  wire        rst,         // synchronous, of the bus
  // the CPU: 8 bytes of its address space
  input  wire        wb_cyc_i,
  input  wire        wb_stb_i,
  input  wire        wb_we_i,
  input  wire [ 2:0] wb_adr_i,
  input  wire [ 3:0] wb_sel_i,
  input  wire [31:0] wb_dat_i,
  output wire [31:0] wb_dat_o,
  output wire        wb_ack_o,
  output wire        wb_err_o,
  output wire        irq,         // an axis was stopped
  // the machine
  input  wire        estop_n,     // asynchronous; low: EN is deasserted asynchronously
  input  wire [ 2:0] limit_low,
  input  wire [ 2:0] limit_high,
  output wire [ 2:0] step,
  output wire [ 2:0] dir,
  output wire [ 2:0] enable
);

  passo_wishbone #(
    .AXES        (3),
    .INPUTS      (1),
    .ENABLE_RESET(3'b111)
  ) core (
    .clk          (clk),
    .rst          (rst),
    .wb_cyc_i     (wb_cyc_i),
    .wb_stb_i     (wb_stb_i),
    .wb_we_i      (wb_we_i),
    .wb_adr_i     (wb_adr_i),
    .wb_sel_i     (wb_sel_i),
    .wb_dat_i     (wb_dat_i),
    .wb_dat_o     (wb_dat_o),
    .wb_ack_o     (wb_ack_o),
    .wb_err_o     (wb_err_o),
    .sync         (1'b0),
    .limit_low    (limit_low),
    .limit_high   (limit_high),
    .home         (3'b000),
    .alarm        (3'b000),
    .probe        (1'b0),
    .estop_n      (estop_n),
    .encoder_a    (3'b000),
    .encoder_b    (3'b000),
    .encoder_index(3'b000),
    .step         (step),
    .dir          (dir),
    .enable       (enable),
    .outputs      (),
    .power        (),
    .compare      (),
    .running      (),
    .irq          (irq)
  );

endmodule
