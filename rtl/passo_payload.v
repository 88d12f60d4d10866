// SPDX-License-Identifier: MIT
// Payload: the words of a frame in half words, so that they take one block RAM; and the word on the bus.
//
// Promise: `store` writes a half word. `load` in the two clocks after `load_low` = 0, then 1 named the halves
// of a word puts this word into `data`. 32 clocks of `turn` show it at data[31] bit by bit, leave it as it
// was, and tell what it amounts to: `top_bit` is the number of its highest bit that is set (0 if none is),
// `lone_bit` says that no other is.
`resetall
`default_nettype none

module passo_payload (
  input  wire        clk,
  // in
  input  wire        store,
  input  wire [ 6:0] store_word,
  input  wire        store_low,
  input  wire [15:0] half,
  // out
  input  wire        load,
  input  wire [ 6:0] load_word,
  input  wire        load_low,
  input  wire        turn,
  input  wire [ 4:0] turns,       // 0 .. 31
  output reg  [31:0] data,
  output reg  [ 4:0] top_bit,
  output reg         lone_bit
);

  wire [15:0] loaded;

  passo_memory #(
    .WIDTH     (16),
    .DEPTH_LOG2(8)
  ) u_words (
    .clk          (clk),
    .write        (store),
    .write_address({store_word, store_low}),
    .write_data   (half),
    .read_address ({load_word, load_low}),
    .read_data    (loaded)
  );

  // Before the first word it means nothing, but it should be something.
  initial data = 32'd0;

  reg some_bit;

  always @(posedge clk) begin
    if (load || turn) data <= turn ? {data[30:0], data[31]} : {data[15:0], loaded};
    if (turn && data[31]) begin
      some_bit <= 1'b1;
      if (some_bit) lone_bit <= 1'b0;
      else top_bit <= ~turns;
    end
    if (load) begin
      some_bit <= 1'b0;
      lone_bit <= 1'b1;
      top_bit  <= 5'd0;
    end
  end

endmodule
`resetall
