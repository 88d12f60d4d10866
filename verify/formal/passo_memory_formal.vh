// SPDX-License-Identifier: MIT
// Promises of the memory; included at the end of passo_memory.v.

// --- Any one address is tracked
(* anyconst *) reg [DEPTH_LOG2-1:0] f_address;
reg             f_written = 1'b0;
reg [WIDTH-1:0] f_word;
reg             f_read = 1'b0;  // the clock before read this address and did not write it
reg [WIDTH-1:0] f_read_word;
reg             f_loaded = 1'b0;  // the last `load` found it
reg [WIDTH-1:0] f_loaded_word;
wire            f_is_written = write && write_address == f_address;
wire            f_there = DATA_REGISTER != 0 ? f_loaded : f_read;
always @(posedge clk) begin
  if (f_is_written) begin
    f_written <= 1'b1;
    f_word    <= write_data;
  end
  f_read      <= f_written && read_address == f_address && !f_is_written;
  f_read_word <= f_word;
  if (load) begin
    f_loaded      <= f_read;
    f_loaded_word <= f_read_word;
  end
  if (f_there) read_is_last_written : assert (read_data == (DATA_REGISTER != 0 ? f_loaded_word : f_read_word));
  if (f_written) assert (words[f_address] == f_word);
  if (f_read) assert (f_written && word == f_read_word);
end
