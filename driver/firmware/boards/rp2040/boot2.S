/* Second stage of the RP2040's start: the first 256 bytes of the flash, which the ROM copies to RAM and runs [S RP2040
   datasheet, 2.8.1.3.1]. Sets the flash interface to the plain read command 03h, which each serial flash has, and starts the
   image behind it. image.py writes the checksum. Registers: section 4.10.13. */
  .syntax unified
  .cpu cortex-m0plus
  .thumb
  .section .boot, "ax"
  ldr r3, =0x18000000
  movs r1, #0
  str r1, [r3, #0x08]     /* SSIENR: off */
  movs r1, #4
  str r1, [r3, #0x14]     /* BAUDR: system clock over 4 */
  ldr r1, =0x001f0300     /* CTRLR0: 32-bit frames, read only after the command */
  str r1, [r3, #0x00]
  movs r1, #0
  str r1, [r3, #0x04]     /* CTRLR1: one frame */
  ldr r1, =0x03000218     /* SPI_CTRLR0: command 03h of 8 bits, address of 24 bits */
  ldr r2, =0x180000f4
  str r1, [r2]
  movs r1, #1
  str r1, [r3, #0x08]     /* SSIENR: on */
  ldr r0, =0x10000100     /* the vector table of the image */
  ldr r1, =0xe000ed08     /* VTOR */
  str r0, [r1]
  ldr r1, [r0]
  msr msp, r1
  ldr r1, [r0, #4]
  bx r1
  .ltorg
  .org 252
  .word 0                 /* checksum */
