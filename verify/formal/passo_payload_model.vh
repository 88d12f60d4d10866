// SPDX-License-Identifier: MIT
// The payload buffer as the proof of the link sees it, included in passo_payload in the place of its promises: it
// keeps the header and one word of the payload, any one (`f_place`); every other word, and a word that turns, is
// anything. The script cuts all outputs off the buffer.

(* keep *) wire [5:0] f_place;
(* keep *) reg [31:0] f_header;
(* keep *) reg [31:0] f_word;
(* keep *) reg [31:0] f_held;
(* anyseq *) wire [31:0] f_anything;
reg [15:0] f_named;
reg [15:0] f_loaded;

wire [31:0] f_read = load_word == 7'h40 ? f_header : load_word == {1'b0, f_place} ? f_word : f_anything;

always @(posedge clk) begin
  if (store && store_word == 7'h40 && !store_low) f_header[31:16] <= half;
  if (store && store_word == 7'h40 && store_low) f_header[15:0] <= half;
  if (store && store_word == {1'b0, f_place} && !store_low) f_word[31:16] <= half;
  if (store && store_word == {1'b0, f_place} && store_low) f_word[15:0] <= half;
  f_named  <= load_low ? f_read[15:0] : f_read[31:16];
  f_loaded <= f_named;
  if (load) f_held <= load_zero ? 32'd0 : {f_held[15:0], f_loaded};
end
always @* if (!rotate) payload_as_stored : assume (data == f_held);
