-- SPDX-License-Identifier: MIT
-- The core in a VHDL design: three axes behind SPI, with limit switches and an e-stop. See motion_top.v.
library ieee;
use ieee.std_logic_1164.all;

entity motion_top is
  port (
    clk        : in  std_logic; -- at least four times SCLK
    rst        : in  std_logic; -- asynchronous, such as a button or a PLL that is not locked
    -- the host, SPI mode 0; pulls: chip select up, SCLK down
    spi_sclk   : in  std_logic;
    spi_mosi   : in  std_logic;
    spi_cs_n   : in  std_logic;
    spi_miso   : out std_logic;
    irq        : out std_logic; -- an axis was stopped
    -- the machine
    estop_n    : in  std_logic; -- asynchronous; low: EN is deasserted asynchronously
    limit_low  : in  std_logic_vector(2 downto 0);
    limit_high : in  std_logic_vector(2 downto 0);
    step       : out std_logic_vector(2 downto 0);
    dir        : out std_logic_vector(2 downto 0);
    enable     : out std_logic_vector(2 downto 0)
  );
end entity;

architecture rtl of motion_top is

  -- All ports and parameters of rtl/passo_spi_top.v, for any number of axes. Names in backslashes are
  -- case-sensitive, as those of Verilog are: \OUTPUTS\ is a parameter, outputs a port.
  component passo_spi_top is
    generic (
      \CHANNELS\        : natural := 1; -- 1 .. 8
      \AXES\            : natural := 4; -- per channel, 1 .. 8
      \TICK_LOG2\       : natural := 7;
      \LINE_QUEUE_LOG2\ : natural := 8;
      \RAMP_QUEUE_LOG2\ : natural := 4;
      \STEPS_REGISTER\  : natural := 0;
      \INPUTS\          : natural := 0;
      \ENCODERS\        : natural := 0;
      \OUTPUTS\         : natural := 0;
      \RASTER\          : natural := 0;
      \COMPARE\         : natural := 0;
      \TRACKERS\        : natural := 0;
      \TRACKED\         : natural := 0; -- the last axes have no lines
      \CLOCK_HZ\        : natural := 0; -- the host can read it
      \BUILD\           : natural := 0; -- and this
      \STEP_RESET\      : natural := 0; -- bit channel * \AXES\ + axis
      \DIR_RESET\       : natural := 0;
      \ENABLE_RESET\    : natural := 0
    );
    port (
      clk             : in  std_logic;
      rst             : in  std_logic;
      spi_sclk        : in  std_logic;
      spi_mosi        : in  std_logic;
      spi_cs_n        : in  std_logic;
      spi_miso        : out std_logic;
      spi_miso_enable : out std_logic;
      sync            : in  std_logic;
      limit_low       : in  std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      limit_high      : in  std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      home            : in  std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      alarm           : in  std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      probe           : in  std_logic_vector(\CHANNELS\ - 1 downto 0);
      estop_n         : in  std_logic;
      encoder_a       : in  std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      encoder_b       : in  std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      encoder_index   : in  std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      step            : out std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      dir             : out std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      enable          : out std_logic_vector(\CHANNELS\ * \AXES\ - 1 downto 0);
      outputs         : out std_logic_vector(\CHANNELS\ * 8 - 1 downto 0);
      power           : out std_logic_vector(\CHANNELS\ - 1 downto 0);
      compare         : out std_logic_vector(\CHANNELS\ - 1 downto 0);
      running         : out std_logic_vector(\CHANNELS\ - 1 downto 0);
      irq             : out std_logic
    );
  end component;

  signal reset : std_logic_vector(1 downto 0) := "11";

begin

  -- asserted asynchronously, released on a clock
  process (clk, rst)
  begin
    if rst = '1' then
      reset <= "11";
    elsif rising_edge(clk) then
      reset <= reset(0) & '0';
    end if;
  end process;

  core : passo_spi_top
    generic map (
      \AXES\         => 3,
      \INPUTS\       => 1,
      \ENABLE_RESET\ => 7
    )
    port map (
      clk             => clk,
      rst             => reset(1),
      spi_sclk        => spi_sclk,
      spi_mosi        => spi_mosi,
      spi_cs_n        => spi_cs_n,
      spi_miso        => spi_miso,
      spi_miso_enable => open,
      sync            => '0',
      limit_low       => limit_low,
      limit_high      => limit_high,
      home            => "000",
      alarm           => "000",
      probe           => "0",
      estop_n         => estop_n,
      encoder_a       => "000",
      encoder_b       => "000",
      encoder_index   => "000",
      step            => step,
      dir             => dir,
      enable          => enable,
      outputs         => open,
      power           => open,
      compare         => open,
      running         => open,
      irq             => irq
    );

end architecture;
