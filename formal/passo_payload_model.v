// SPDX-License-Identifier: MIT
// Model of passo_payload for the proof of the link: it keeps the header and any one word of the payload (`f_place`);
// every other word, and a rotating word, is anything.
`resetall
`default_nettype none

module passo_payload (
  input  wire        clk,
  input  wire        store,
  input  wire [ 6:0] store_word,
  input  wire        store_low,
  input  wire [15:0] half,
  input  wire        put,
  input  wire [ 6:0] put_word,
  input  wire        put_low,
  input  wire        load,
  input  wire [ 6:0] load_word,
  input  wire        load_low,
  input  wire        load_zero,
  input  wire        rotate,
  input  wire [ 4:0] bit_index,
  input  wire        count,
  input  wire [ 1:0] counter,
  output wire [31:0] data,
  output wire [ 4:0] msb,
  output wire        one_hot,
  output wire        counter_bit
);

  (* keep *)wire [ 5:0] f_place;
  (* keep *)reg  [31:0] f_header;
  (* keep *)reg  [31:0] f_word;
  (* keep *)reg  [31:0] f_held;
  (* anyseq *)wire [31:0] f_anything;
  (* anyseq *)wire [ 6:0] f_any_bits;
  reg  [15:0] f_named;
  reg  [15:0] loaded;

  wire [31:0] f_read = load_word == 7'h40 ? f_header : load_word == {1'b0, f_place} ? f_word : f_anything;

  assign {msb, one_hot, counter_bit} = f_any_bits;
  assign data                        = rotate ? f_anything : f_held;

  always @(posedge clk) begin
    if (store && store_word == 7'h40 && !store_low) f_header[31:16] <= half;
    if (store && store_word == 7'h40 && store_low) f_header[15:0] <= half;
    if (store && store_word == {1'b0, f_place} && !store_low) f_word[31:16] <= half;
    if (store && store_word == {1'b0, f_place} && store_low) f_word[15:0] <= half;
    f_named <= load_low ? f_read[15:0] : f_read[31:16];
    loaded  <= f_named;
    if (load) f_held <= load_zero ? 32'd0 : {f_held[15:0], loaded};
  end

endmodule
`resetall
