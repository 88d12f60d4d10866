// SPDX-License-Identifier: MIT
// What the memory promises; included at the end of passo_memory.

// --- One address, any one, is watched
(* anyconst *) reg [DEPTH_LOG2-1:0] f_address;
reg             f_written = 1'b0;
reg [WIDTH-1:0] f_word;
reg             f_read = 1'b0;  // the clock before read the watched address, and nothing was written to it
always @(posedge clk) begin
  if (write && write_address == f_address) begin
    f_written <= 1'b1;
    f_word    <= write_data;
  end
  f_read <= f_written && read_address == f_address && !(write && write_address == f_address);
  if (f_read) read_is_last_written : assert (read_data == f_word || $past(write && write_address == f_address));
`ifdef INVARIANTS
  if (f_written) assert (words[f_address] == f_word);
  if (f_read) assert (f_written);
`endif
end
