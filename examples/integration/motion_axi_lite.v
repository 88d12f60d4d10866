// SPDX-License-Identifier: MIT
// The core in a design of your own: three axes behind AXI4-Lite, with limit switches and an e-stop.
//
// Drives with an active-low enable: EN is high, and so the drives are off, from configuration until the host
// enables them.
`timescale 1ns / 1ps

module motion_top (
  input  wire        clk,
  input  wire        rst,             // synchronous, of the bus
  // the CPU: 8 bytes of its address space
  input  wire [ 2:0] s_axil_awaddr,
  input  wire [ 2:0] s_axil_awprot,
  input  wire        s_axil_awvalid,
  output wire        s_axil_awready,
  input  wire [31:0] s_axil_wdata,
  input  wire [ 3:0] s_axil_wstrb,
  input  wire        s_axil_wvalid,
  output wire        s_axil_wready,
  output wire [ 1:0] s_axil_bresp,
  output wire        s_axil_bvalid,
  input  wire        s_axil_bready,
  input  wire [ 2:0] s_axil_araddr,
  input  wire [ 2:0] s_axil_arprot,
  input  wire        s_axil_arvalid,
  output wire        s_axil_arready,
  output wire [31:0] s_axil_rdata,
  output wire [ 1:0] s_axil_rresp,
  output wire        s_axil_rvalid,
  input  wire        s_axil_rready,
  output wire        irq,             // an axis was stopped
  // the machine
  input  wire        estop_n,         // asynchronous; low: EN is deasserted asynchronously
  input  wire [ 2:0] limit_low,
  input  wire [ 2:0] limit_high,
  output wire [ 2:0] step,
  output wire [ 2:0] dir,
  output wire [ 2:0] enable
);

  passo_axi_lite #(
    .AXES        (3),
    .INPUTS      (1),
    .ENABLE_RESET(3'b111)
  ) core (
    .clk           (clk),
    .rst           (rst),
    .s_axil_awaddr (s_axil_awaddr),
    .s_axil_awprot (s_axil_awprot),
    .s_axil_awvalid(s_axil_awvalid),
    .s_axil_awready(s_axil_awready),
    .s_axil_wdata  (s_axil_wdata),
    .s_axil_wstrb  (s_axil_wstrb),
    .s_axil_wvalid (s_axil_wvalid),
    .s_axil_wready (s_axil_wready),
    .s_axil_bresp  (s_axil_bresp),
    .s_axil_bvalid (s_axil_bvalid),
    .s_axil_bready (s_axil_bready),
    .s_axil_araddr (s_axil_araddr),
    .s_axil_arprot (s_axil_arprot),
    .s_axil_arvalid(s_axil_arvalid),
    .s_axil_arready(s_axil_arready),
    .s_axil_rdata  (s_axil_rdata),
    .s_axil_rresp  (s_axil_rresp),
    .s_axil_rvalid (s_axil_rvalid),
    .s_axil_rready (s_axil_rready),
    .sync          (1'b0),
    .limit_low     (limit_low),
    .limit_high    (limit_high),
    .home          (3'b000),
    .alarm         (3'b000),
    .probe         (1'b0),
    .estop_n       (estop_n),
    .encoder_a     (3'b000),
    .encoder_b     (3'b000),
    .encoder_index (3'b000),
    .step          (step),
    .dir           (dir),
    .enable        (enable),
    .outputs       (),
    .power         (),
    .compare       (),
    .running       (),
    .irq           (irq)
  );

endmodule
