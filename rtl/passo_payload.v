// SPDX-License-Identifier: MIT
// Payload: the words of a frame, as half-words so that they take one block RAM, and the word on the bus. Behind them
// are two words of 4 reject counters each.
//
// Promise: `store` writes a half-word. `load`, two clocks after `load_low` = 0, then 1 selected the halves of a word,
// puts this word into `data`, or 0 with `load_zero`. 32 clocks of `rotate` show it at data[31] bit by bit, leave it
// unchanged, and decode it: `msb` is the index of its highest set bit (0 if none is set), `one_hot` says that no
// other bit is set.
//
// Bits pass MSB first, but counting starts at the LSB: each counter is stored bit-reversed. `count` adds 1 to counter
// `counter` as the word rotates; `put` stores data[15:0], which is the upper half after 16 clocks, the lower after
// 32, and has priority over `store`. `counter_bit` is the bit to pass if a word of counters is shown in normal bit
// order.
`resetall
`timescale 1ns / 1ps
`default_nettype none

module passo_payload (
  input  wire        clk,
  // in
  input  wire        store,
  input  wire [ 6:0] store_word,
  input  wire        store_low,
  input  wire [15:0] half,
  input  wire        put,
  input  wire [ 6:0] put_word,
  input  wire        put_low,
  // out
  input  wire        load,
  input  wire [ 6:0] load_word,
  input  wire        load_low,
  input  wire        load_zero,
  input  wire        rotate,
  input  wire [ 4:0] bit_index,   // rotations so far, 0 .. 31
  input  wire        count,
  input  wire [ 1:0] counter,
  output reg  [31:0] data,
  output reg  [ 4:0] msb,
  output reg         one_hot,
  output reg         counter_bit
);

  wire [15:0] loaded;

  passo_memory #(
    .WIDTH     (16),
    .DEPTH_LOG2(8)
  ) u_words (
    .clk          (clk),
    .write        (store || put),
    .write_address(put ? {put_word, put_low} : {store_word, store_low}),
    .write_data   (put ? data[15:0] : half),
    .read_address ({load_word, load_low}),
    .load         (1'b1),
    .read_data    (loaded)
  );

  // Meaningless before the first word, but defined.
  initial data = 32'd0;

  reg  some_bit;
  wire in_counter = count && bit_index[4:3] == ~counter;
  reg  carry;

  // One clock ahead of its rotation, while the bit is one place lower
  always @(posedge clk)
    if (!rotate) counter_bit <= data[24];
    else
      case (bit_index[2:0])
        3'd0: counter_bit <= data[25];
        3'd1: counter_bit <= data[27];
        3'd2: counter_bit <= data[29];
        3'd3: counter_bit <= data[31];
        3'd4: counter_bit <= data[1];
        3'd5: counter_bit <= data[3];
        3'd6: counter_bit <= data[5];
        3'd7: counter_bit <= data[23];
      endcase

  always @(posedge clk) begin
    carry <= !in_counter || (carry && data[31]);
    if (load && load_zero) data <= 32'd0;
    else if (load || rotate)
      data <= rotate ? {data[30:0], data[31] ^ (in_counter && carry)} : {data[15:0], loaded};
    if (rotate && data[31]) begin
      some_bit <= 1'b1;
      if (some_bit) one_hot <= 1'b0;
      else msb <= ~bit_index;
    end
    if (load) begin
      some_bit <= 1'b0;
      one_hot  <= 1'b1;
      msb      <= 5'd0;
    end
  end

`ifdef FORMAL
  `include "passo_payload_formal.vh"
`endif

endmodule
`resetall
