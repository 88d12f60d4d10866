// SPDX-License-Identifier: MIT
// Ramp: velocity over time. A tick is 2^TICK_LOG2 enabled clocks; while one tick runs, the velocity of the
// next is made.
//
//   s        = shape(u);  velocity = v_start + floor((v_end - v_start) * s);  u += du      first u = du / 2
//   after T ticks the next ramp begins, from exactly v_end; T = 0 sets the velocity at once
//
//   velocity   |        ____________
//              |      /              \            v_start, v_end: of the ramp being made
//              |    /                  \          velocity, velocity_next: of this tick, of the next
//              |__/_____________________ \__
//                 ramp   ramp (T ticks)  ramp
//
// `prepare` makes the first velocity of a motion, from 0, and raises `ready`; `begin_profile` starts the
// first tick.
// Promise: the LAST ramp's end raises `ended`, with the last enabled clock of its last tick (a profile
// without any tick: with begin_profile). Ramps that run out at speed raise `dry`, one tick ahead; the
// velocity then stays, and the next ramp is taken whenever it comes. `stall` holds the enable back at the end
// of a tick until the next velocity is ready: later, never lost; in a tick of 128 clocks there is time for a
// ramp and, on a core of one channel, two with T = 0 before it.
`resetall
`default_nettype none

module passo_ramp #(
  parameter TICK_LOG2 = 7
) (
  input  wire        clk,
  input  wire        rst,
  // motion
  input  wire        prepare,
  input  wire        begin_profile,
  input  wire        stop,              // forget everything
  input  wire        drain,             // drain_velocity counts, not the ramps
  input  wire [31:0] drain_velocity,    // UQ0.32
  output reg         ready,             // velocity_next is
  output wire        ended,
  output reg         dry,
  // timescale and path
  input  wire        advance,           // an enabled clock that counts
  output wire        stall,
  output reg  [47:0] velocity,          // UQ0.48 substeps per clock
  // ramp queue
  input  wire        ramp_valid,
  input  wire        ramp_now_pending,
  output reg         ramp_take,
  output reg         ramp_take_now,
  output reg  [ 3:0] ramp_half_index,
  input  wire [15:0] ramp_half,
  // tables
  output wire        table_request,
  output wire [ 9:0] table_address,
  input  wire        table_served,
  input  wire [15:0] table_point,
  input  wire [15:0] table_point_next
);

  localparam [2:0] STEP_IDLE = 3'd0;
  localparam [2:0] STEP_CHOOSE = 3'd1;
  localparam [2:0] STEP_LOAD = 3'd2;
  localparam [2:0] STEP_SHAPE = 3'd3;
  localparam [2:0] STEP_SCALE = 3'd4;

  localparam [TICK_LOG2-1:0] TICK_LAST = {TICK_LOG2{1'b1}};

  reg [2:0] step;

  // the ramp being made
  reg        last;
  reg        mirror;
  reg [ 1:0] shape;
  reg [47:0] v_start;
  reg [47:0] v_end;
  reg [31:0] ticks;  // still to be made
  reg        ticks_left;
  reg [47:0] progress;  // u
  reg        progress_carry;
  reg [47:0] progress_step;  // du
  reg [ 3:0] half_index_q;  // of ramp_half
  reg        half_valid;

  // the tick that runs, and the one after it
  reg [TICK_LOG2-1:0] tick_count;
  reg                 tick_last;
  reg                 ends_next;

  wire tick = advance & tick_last;
  wire next = begin_profile | tick;

  assign ended = next & ends_next;
  assign stall = tick_last & ~ready & ~drain;

  reg         shape_start;
  wire        shape_done;
  wire [24:0] s;
  reg         scale_start;
  wire        scale_done;
  wire [47:0] scale_velocity;

  passo_shape u_shape (
    .clk             (clk),
    .rst             (rst | stop),
    .start           (shape_start),
    .progress        (progress[47:23]),
    .shape           (shape),
    .mirror          (mirror),
    .done            (shape_done),
    .s               (s),
    .table_request   (table_request),
    .table_address   (table_address),
    .table_served    (table_served),
    .table_point     (table_point),
    .table_point_next(table_point_next)
  );

  passo_scale u_scale (
    .clk     (clk),
    .rst     (rst | stop),
    .start   (scale_start),
    .v_start (v_start),
    .v_end   (v_end),
    .s       (s),
    .done    (scale_done),
    .velocity(scale_velocity)
  );

  // The velocity of the next tick
  reg [47:0] velocity_next;

  always @(posedge clk) begin
    shape_start   <= 1'b0;
    scale_start   <= 1'b0;
    ramp_take     <= 1'b0;
    ramp_take_now <= 1'b0;
    dry           <= 1'b0;
    ticks_left    <= ticks != 32'd0;
    half_index_q  <= ramp_half_index;
    half_valid    <= 1'b0;

    case (step)
      STEP_CHOOSE: begin
        ramp_half_index <= 4'd0;
        if (ramp_now_pending) begin
          ramp_take_now <= 1'b1;
          v_end         <= velocity;
          step          <= STEP_LOAD;
        end else if (ticks_left) begin
          shape_start <= 1'b1;
          step        <= STEP_SHAPE;
        end else if (!last && ramp_valid) step <= STEP_LOAD;
        else begin
          velocity_next <= last ? 48'd0 : v_end;
          ends_next     <= last;
          dry           <= !last && v_end != 48'd0;
          ready         <= 1'b1;
          step          <= STEP_IDLE;
        end
      end

      STEP_LOAD: begin
        // the first clock lets a take_now reach the queue, the second its memory
        if (!ramp_take_now && !(half_valid && half_index_q == 4'd9)) begin
          ramp_half_index <= ramp_half_index + 4'd1;
          half_valid      <= 1'b1;
        end
        if (half_valid)
          case (half_index_q)
            4'd0: begin
              v_start      <= v_end;
              v_end[47:32] <= ramp_half;
            end
            4'd1: {shape, mirror, last} <= {ramp_half[5:4], ramp_half[2], ramp_half[0]};
            4'd2: v_end[31:16] <= ramp_half;
            4'd3: v_end[15:0] <= ramp_half;
            4'd4: ticks[31:16] <= ramp_half;
            4'd5: ticks[15:0] <= ramp_half;
            4'd6: ;
            4'd7: progress_step[47:32] <= ramp_half;
            4'd8: begin
              progress_step[31:16] <= ramp_half;
              ramp_take            <= 1'b1;  // so that ramp_valid is true again in STEP_CHOOSE
            end
            default: begin
              progress_step[15:0] <= ramp_half;
              progress            <= {1'b0, progress_step[47:16], ramp_half[15:1]};
              step                <= STEP_CHOOSE;
            end
          endcase
      end

      STEP_SHAPE:
      if (shape_done) begin
        scale_start                      <= 1'b1;
        {progress_carry, progress[23:0]} <= {1'b0, progress[23:0]} + {1'b0, progress_step[23:0]};
        step                             <= STEP_SCALE;
      end

      STEP_SCALE: begin
        if (scale_start) progress[47:24] <= progress[47:24] + progress_step[47:24] + {23'd0, progress_carry};
        if (scale_done) begin
          velocity_next <= scale_velocity;
          ends_next     <= 1'b0;
          ticks         <= ticks - 32'd1;
          ready         <= 1'b1;
          step          <= STEP_IDLE;
        end
      end

      default: ;
    endcase

    if (prepare) begin
      v_end     <= 48'd0;
      velocity  <= 48'd0;
      ticks     <= 32'd0;
      last      <= 1'b0;
      ready     <= 1'b0;
      ends_next <= 1'b0;
      step      <= STEP_CHOOSE;
    end

    if (advance) begin
      tick_count <= tick_count + 1'b1;
      tick_last  <= tick_count == TICK_LAST - 1'b1;
    end
    if (next) begin
      velocity <= velocity_next;
      ready    <= 1'b0;
      if (!ends_next) step <= STEP_CHOOSE;
    end
    if (begin_profile) begin
      tick_count <= {TICK_LOG2{1'b0}};
      tick_last  <= 1'b0;
    end
    if (drain) velocity <= {drain_velocity, 16'd0};

    if (rst || stop) begin
      step          <= STEP_IDLE;
      ready         <= 1'b0;
      ends_next     <= 1'b0;
      velocity      <= 48'd0;
      ticks         <= 32'd0;
      last          <= 1'b0;
      shape_start   <= 1'b0;
      scale_start   <= 1'b0;
      ramp_take     <= 1'b0;
      ramp_take_now <= 1'b0;
      tick_last     <= 1'b0;
    end
  end

endmodule
`resetall
