#!/bin/bash
# Runs docs/rolltank@.service under the systemd of Debian trixie (257), booted in namespaces of its
# own, with an emulated board behind a pseudo-terminal that only root and its dialout may open.
# Shows: active after READY=1, alive beyond its watchdog, reloaded, killed by the watchdog when it
# hangs and started again, stopped with a whole recording, and kept from what it may not touch.
#
#   cargo build --release && sudo tests/systemd/under_systemd.sh [FOLDER]
#
# FOLDER keeps the Debian tree (default /var/tmp/rolltank-trixie); the first time 150 MB are fetched
# by debootstrap. Needs root, debootstrap, python3 and a cgroup2 hierarchy to mount.
set -eu
top=$(cd "$(dirname "$0")/../.." && pwd)
tree=${1:-/var/tmp/rolltank-trixie}
program=${ROLLTANK:-$top/target/release/rolltank}
campaign=/srv/tank/today
unit=rolltank@srv-tank-today.service

[ -x "$tree/usr/lib/systemd/systemd" ] || debootstrap --variant=minbase \
    --include=systemd,systemd-sysv,dbus trixie "$tree" http://deb.debian.org/debian
chroot "$tree" id rolltank >/dev/null 2>&1 || chroot "$tree" useradd --system -G dialout rolltank
install -m755 "$program" "$tree/usr/bin/rolltank"
install -m644 "$top/docs/rolltank@.service" "$tree/etc/systemd/system/"
rm -rf "$tree$campaign" "$tree/var/log/journal"
mkdir -p "$tree$campaign/ports"
cat >"$tree$campaign/campaign.toml" <<END
name = "under systemd"
[hull]
length_pp_m = 2.5
beam_m = 0.387
draft_m = 0.132
displacement_m3 = 0.110
gm_m = 0.074
[[device]]
name = "board"
profile = "arduino-text"
port = "$campaign/ports/board"
settings = { pattern = "\$RD,{sequence},{time_us},{0}*{xor}" }
[[device.channel]]
quantity = "roll"
field = 0
calibration = { curve = { gain = 1e-5 } }
END
dialout=$(chroot "$tree" getent group dialout | cut -d: -f3)
python3 "$top/tests/systemd/board.py" "$tree$campaign/ports/board" "$dialout" &
board=$!
sleep 1
chroot "$tree" chown -R rolltank: "$campaign"

# A cgroup of its own is the root of what this systemd sees.
outer=$(mount -t cgroup2 | awk '{ print $3; exit }')
group=$outer/rolltank-systemd
mkdir -p "$group"
env -i container=other unshare --mount --pid --fork --uts --ipc --propagation private bash -c '
    tree=$0 group=$1
    echo $$ >"$group/cgroup.procs"
    exec unshare --cgroup bash -c "
        set -e
        mount --rbind $tree $tree
        mount -t proc proc $tree/proc
        mount -t sysfs -o ro sysfs $tree/sys
        mount -t tmpfs tmpfs $tree/sys/fs/cgroup && mount -t cgroup2 cgroup2 $tree/sys/fs/cgroup
        mount --rbind /dev $tree/dev
        mount -t tmpfs tmpfs $tree/run
        exec chroot $tree /usr/lib/systemd/systemd --unit=multi-user.target
    "' "$tree" "$group" >"$tree/var/log/boot.log" 2>&1 &
shell=$!
# What ran in the cgroup takes a moment to be gone.
leave() {
    for _ in $(seq 25); do
        find "$group" -depth -type d -exec rmdir {} + 2>/dev/null || true
        [ -d "$group" ] || return 0
        sleep 0.2
    done
}
trap 'set +e; kill "$board" 2>/dev/null; [ -z "${init:-}" ] || kill -9 "$init" 2>/dev/null; wait "$shell" 2>/dev/null; leave' EXIT
init=
for _ in $(seq 50); do
    init=$(pgrep -f -P "$shell" . | head -1 || true)
    [ -n "$init" ] && nsenter -t "$init" -m -p -C -r systemctl is-system-running 2>/dev/null |
        grep -qE 'running|degraded' && break
    sleep 0.2
done
inside() { nsenter -t "$init" -m -p -C -r -w "$@"; }
show() { inside systemctl show "$unit" -p "$1" --value; }
say() { printf '%s\n' "$*"; }
fail() { say "FAILED: $*"; inside journalctl -u "$unit" --no-pager -n 40; exit 1; }
now() { date +%s.%N; }
took() { echo "$1 $2" | awk '{ printf "%.2f s", $2 - $1 }'; }

say "$(inside systemctl --version | head -1), pid 1 of its own: $(inside systemctl is-system-running || true)"
say "verify: $(inside systemd-analyze verify "/etc/systemd/system/$unit" 2>&1 | head -3)"
say "$(inside systemd-analyze security "$unit" 2>/dev/null | tail -1)"

a=$(now); inside systemctl start "$unit" || fail start; b=$(now)
say "started in $(took "$a" "$b"): $(show ActiveState), $(show StatusText), type $(show Type)"
[ "$(show ActiveState)" = active ] || fail "not active"
pid=$(show MainPID)

sleep 25
[ "$(show NRestarts)" = 0 ] && [ "$(show MainPID)" = "$pid" ] || fail "restarted"
say "alive after 25 s of a watchdog of $(show WatchdogUSec): same process"
runs=$(inside sh -c "ls $campaign/results" | grep -c '^run-.*html' || true)
say "reports written: $runs"

a=$(now); inside systemctl reload "$unit" || fail reload; b=$(now)
say "reload returned after $(took "$a" "$b"): $(show ActiveState), same process: $([ "$(show MainPID)" = "$pid" ] && echo yes || echo no)"

a=$(now); inside sh -c "kill -STOP $pid"
for _ in $(seq 300); do
    [ "$(show NRestarts)" -ge 1 ] && [ "$(show ActiveState)" = active ] && break
    sleep 0.1
done
b=$(now)
[ "$(show NRestarts)" -ge 1 ] || fail "the watchdog let it hang"
say "hung for its watchdog, then restarted and active after $(took "$a" "$b")"
sleep 8

a=$(now); inside systemctl stop "$unit" || fail stop; b=$(now)
say "stopped in $(took "$a" "$b"): $(show Result), exit $(show ExecMainStatus)"
say "recordings: $(inside sh -c "ls $campaign/live")"
inside sh -c "ls $campaign/live/*.part" >/dev/null 2>&1 && fail "a part was left"
say "decays in them: $("$program" identify "$tree$campaign" 2>&1 | grep -c ' decay ')"
inside journalctl -u "$unit" --no-pager -o cat | grep -iE 'denied|not permitted|read-only' && fail "hardening blocks it"
say "nothing was denied"

# The same unit with a shell as root, capabilities and all, in the place of the program: what still
# stands in its way is the hardening.
sed -e 's/^Type=.*/Type=oneshot/; s/^User=.*/User=root/; s/^\(WatchdogSec\|Restart\|Capability\).*//' \
    -e 's|^ExecStart=.*|ExecStart=/bin/sh /srv/tank/probe|' "$top/docs/rolltank@.service" \
    >"$tree/etc/systemd/system/probe@.service"
cat >"$tree/srv/tank/probe" <<END
can() { if sh -c "\$2" 2>/dev/null; then echo "can \$1"; else echo "cannot \$1"; fi; }
can "write its folder" "echo 1 >$campaign/probe"
can "write /etc" "echo 1 >/etc/probe"
can "write /srv" "echo 1 >/srv/probe"
can "open a serial board's terminal" ": <$campaign/ports/board"
can "open a serial port" "stty -F /dev/ttyS0"
can "open a memory device" ": </dev/kmsg"
can "open a disk" ": <$(find /dev -maxdepth 1 -type b | sort | head -1)"
can "set the host's name" "hostname probe"
END
inside systemctl daemon-reload
inside systemctl start probe@srv-tank-today.service || fail probe
inside journalctl -u probe@srv-tank-today.service --no-pager -o cat | grep -E '^can'
rm "$tree/etc/systemd/system/probe@.service" "$tree/srv/tank/probe"
