// SPDX-License-Identifier: MIT
// The memory as a proof sees it, included in passo_memory in the place of its promises: only one address,
// `f_address`, keeps its word (`f_word`); every other one, and a word that is being written, reads as anything.
// Whoever proves something with it chooses the address freely: the script connects `f_address` and `f_word`, and
// cuts `word` off the words.

(* keep *) wire [DEPTH_LOG2-1:0] f_address;
(* keep *) reg [WIDTH-1:0] f_word;
(* anyseq *) wire [WIDTH-1:0] f_anything;
reg [WIDTH-1:0] f_read;

wire f_written = write && write_address == f_address;

always @(posedge clk) begin
  if (f_written) f_word <= write_data;
  f_read <= read_address == f_address && !f_written ? f_word : f_anything;
end
always @* memory_as_written : assume (word == f_read);
