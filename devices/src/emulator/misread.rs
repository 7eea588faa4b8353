//! What a line at one speed brings where it is read at another.

use std::collections::VecDeque;

/// Start bit, eight data bits, the lowest first, and the stop bit.
const BITS: usize = 10;

/// The bytes that a receiver at `read_baud` makes of bytes sent without a pause at `sent_baud`.
///
/// It looks at the line in the middle of each of its own bits, as the chips do; a byte without a
/// stop bit is delivered as zero, as the system delivers a framing error.
pub(super) fn misread(bytes: &[u8], sent_baud: u32, read_baud: u32) -> Vec<u8> {
    if sent_baud == read_baud {
        return bytes.to_vec();
    }
    let mut line: VecDeque<bool> = VecDeque::new();
    for byte in bytes {
        line.push_back(false);
        line.extend((0..8).map(|bit| byte >> bit & 1 == 1));
        line.push_back(true);
    }
    // Bits of the sender that pass in one of the receiver.
    let ratio = f64::from(sent_baud) / f64::from(read_baud);
    let is_high = |at: f64| line.get(at as usize).copied().unwrap_or(true);
    let n_sent = line.len() as f64;
    let mut read = Vec::new();
    let mut at = 0.0;
    while at < n_sent {
        if is_high(at) {
            at = at.floor() + 1.0;
            continue;
        }
        let bits: Vec<bool> =
            (0..BITS).map(|bit| is_high(at + (bit as f64 + 0.5) * ratio)).collect();
        let byte = (0..8).filter(|bit| bits[bit + 1]).fold(0, |byte, bit| byte | 1 << bit);
        let has_stop = bits[BITS - 1];
        read.push(if has_stop { byte } else { 0 });
        at += (BITS as f64 - 0.5) * ratio;
        // Without a stop bit the line has to rise before another byte can begin.
        while !has_stop && at < n_sent && !is_high(at) {
            at = at.floor() + 1.0;
        }
    }
    read
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_is_read_as_it_was_sent_at_its_own_speed_alone() {
        let sent = b"$RD,17,340000,-512,8*5C\r\n";
        assert_eq!(misread(sent, 9600, 9600), sent);
        // Two chips whose clocks differ by a few percent understand each other.
        assert_eq!(misread(sent, 9600, 9800), sent);
        // Half as fast a line is twice as many bytes, and none of them a line's end.
        let fast = misread(sent, 9600, 19_200);
        assert!(fast.len() > sent.len() && !fast.contains(&b'\n'), "{fast:02X?}");
        let slow = misread(sent, 9600, 4800);
        assert!(!slow.is_empty() && slow.len() < sent.len(), "{slow:02X?}");
        // A zero at half speed: its nine low bits are over with the third data bit.
        assert_eq!(misread(&[0], 9600, 4800), [0xF8]);
    }
}
