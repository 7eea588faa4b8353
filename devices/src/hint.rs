//! What to do about each [`InstrumentError`], as one sentence for the `hint:` line.

use crate::error::InstrumentError;
use crate::port::PortFault;

impl InstrumentError {
    /// What the user can do about it, where there is more to say than the message does.
    pub fn hint(&self) -> Option<String> {
        Some(match self {
            Self::UnknownProfile { known, .. } => format!("known are {}", known.join(", ")),
            Self::UnknownDriver { .. } => {
                let names: Vec<&str> =
                    crate::driver::DRIVERS.iter().map(|driver| driver.name).collect();
                format!("known are {}", names.join(", "))
            }
            Self::Profile { .. } => "compare it with a profile in devices/profiles".to_owned(),
            Self::Settings { driver, .. } => {
                format!("compare [device.settings] with a profile of driver \"{driver}\"")
            }
            Self::NoChannels { .. } => {
                "add [[device.channel]] with quantity = \"roll\" and field = 0".to_owned()
            }
            Self::NoSuchField { .. } => "field counts from 0".to_owned(),
            Self::NameTwice { .. } => "give each [[device]] a name of its own".to_owned(),
            Self::PortTwice { .. } => {
                "instruments on one bus are one [[device]] with several stations".to_owned()
            }
            Self::AddressTwice { .. } => {
                "set another address in one of them, alone on the bus, by its maker's program"
                    .to_owned()
            }
            Self::ChannelTwice { quantity, .. } => {
                format!(
                    "keep one [[device.channel]] with quantity = \"{}\", drop or rename the other",
                    quantity.name()
                )
            }
            Self::Port { fault, present, .. } => return port_hint(fault, present),
            Self::Garbage { .. } => "check baud and parity against the instrument's own settings, \
                and that the profile is the right one"
                .to_owned(),
            Self::Silent { request: Some(_), .. } => {
                "check power, address, baud and that A and B of RS-485 are not exchanged".to_owned()
            }
            Self::Silent { .. } => {
                "check power and cable, and that the instrument is set to send by itself".to_owned()
            }
            Self::WrongDevice { .. } => {
                "another instrument hangs on this port: exchange the cables or the ports".to_owned()
            }
            Self::Collided { station: Some(_), .. } => {
                "two instruments may have this address and talk at once: switch one off and look \
                 again; else check parity, termination and shield"
                    .to_owned()
            }
            Self::Collided { .. } => {
                "check parity, cable and shield; on a bus, whether two instruments talk at once"
                    .to_owned()
            }
            Self::NotSaid { .. } => {
                "another instrument may hang on this port: look at its label; one that cannot say \
                 who it is needs a [[device]] without identity"
                    .to_owned()
            }
            Self::CannotAsk { driver, .. } => match crate::driver::driver(driver) {
                Some(entry) => format!("{}, or drop identity", entry.asks),
                None => return None,
            },
            Self::Refused { .. } => {
                "compare the settings with the instrument's own; a password may protect it"
                    .to_owned()
            }
            Self::Unasked { .. } => {
                "two instruments may have one address: switch one off and look again".to_owned()
            }
            Self::Number { .. } | Self::Calibration { .. } => return None,
        })
    }
}

fn port_hint(fault: &PortFault, present: &[std::path::PathBuf]) -> Option<String> {
    Some(match fault {
        PortFault::Missing if present.is_empty() => {
            "no serial port is there; plug the adapter in".to_owned()
        }
        PortFault::Missing => {
            let ports: Vec<String> =
                present.iter().map(|port| port.display().to_string()).collect();
            format!("there are {}", ports.join(", "))
        }
        PortFault::Busy => "close the other program; `fuser PORT` names it".to_owned(),
        PortFault::Forbidden => {
            "add the user to group dialout and log in again: `sudo usermod -aG dialout $USER`"
                .to_owned()
        }
        PortFault::NotSerial => "give a port such as /dev/serial/by-id/...".to_owned(),
        PortFault::Refused(_) => {
            "set the instrument to 8N1, or use an adapter that takes this setting".to_owned()
        }
        PortFault::Other(_) => return None,
    })
}
