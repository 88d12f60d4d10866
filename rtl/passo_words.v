// SPDX-License-Identifier: MIT
// Words: host interface for a bus in the same FPGA. A master writes and reads the words of a frame, which are
// processed as if they came over SPI at clk / 4.
//
//   address 0  SELECT  bit 0: a frame is open, like chip select; bit 1, read only: the next access need not wait
//   address 1  WORD    write: the next word of the frame; read: the word exchanged for it
//
// Promise: `request` and its access are held until `done`, which is high for one clock; `error` and `read_data` are
// valid from then until the next one. After a word or a change of SELECT an access waits for 128 clocks, except a
// read of SELECT. Errors, without effect: a write of less than four bytes, or of WORD while no frame is open. The
// first half of a word leaves with its `done`, the second 64 clocks later; frame_start and frame_end come with the
// `done` of SELECT. WORD read before the first word of a frame is the status.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_words (
  input  wire        clk,
  input  wire        rst,
  // bus
  input  wire        request,
  input  wire        write,
  input  wire        address,
  input  wire [ 3:0] lanes,        // bytes that are written
  input  wire [31:0] write_data,
  output reg         done,
  output reg         error,
  output reg  [31:0] read_data,
  // frames
  output wire        frame_start,
  output wire        frame_end,
  output wire        half_valid,
  output wire        half_low,
  output wire [15:0] half,
  input  wire [31:0] reply_word
);

  reg        selected;
  reg        sending;  // a word, not a change of SELECT
  reg [ 6:0] count;  // clocks since then; 0 when they are over
  reg [31:0] word;
  reg [31:0] reply;

  wire ready = count == 7'd0;
  wire begins = count == 7'd1;
  wire accepts = request & ~done & (ready | ~(write | address));
  wire refuses = write & (lanes != 4'hF | (address & ~selected));
  wire writes = accepts & write & ~refuses;
  wire selects = writes & ~address & (write_data[0] != selected);
  wire sends = writes & address;

  assign frame_start = begins & ~sending & selected;
  assign frame_end   = begins & ~sending & ~selected;
  assign half_valid  = sending & count[5:0] == 6'd1;
  assign half_low    = count[6];
  assign half        = count[6] ? word[15:0] : word[31:16];

  always @(posedge clk) begin
    done <= accepts;
    if (accepts) begin
      error     <= refuses;
      read_data <= address ? reply : {30'd0, ready, selected};
    end
    if (selects) selected <= ~selected;
    if (selects || sends) sending <= address;
    if (sends) word <= write_data;
    // the reply is latched at the end of a word, before the core answers this word
    if (count[6] && count[5:0] == 6'd1) reply <= reply_word;
    if (selects || sends || !ready) count <= count + 7'd1;
    if (rst) begin
      done     <= 1'b0;
      selected <= 1'b0;
      count    <= 7'd0;
    end
  end

`ifdef FORMAL
  `include "passo_words_formal.vh"
`endif

endmodule
`resetall
