//! Memory that the process may still have: the least that the machine, the limits of the process and its control groups leave.

use std::fs;
use std::path::Path;

/// Memory that the process may still have, in bytes; `None` where the system does not tell: it does on Linux and in a browser.
pub fn available_bytes() -> Option<u64> {
    let free = field_bytes("/proc/meminfo", "MemAvailable:");
    let groups = fs::read_to_string("/proc/self/cgroup").unwrap_or_default();
    let group = left_in_groups(&groups, Path::new("/sys/fs/cgroup"));
    [free, left_of_limits(), group].into_iter().flatten().min()
}

/// Memory that the limits of the process leave (`ulimit -v` and `-d`).
#[cfg(target_os = "linux")]
fn left_of_limits() -> Option<u64> {
    use rustix::process::{Resource, getrlimit};
    let left = |resource, used| {
        let limit = getrlimit(resource).current?;
        let used = field_bytes("/proc/self/status", used).unwrap_or(0);
        Some(limit.saturating_sub(used))
    };
    let all = left(Resource::As, "VmSize:");
    let data = left(Resource::Data, "VmData:");
    [all, data].into_iter().flatten().min()
}

/// Memory that the limits leave. WebAssembly has addresses for 4 GiB, and a page keeps all that it once took.
#[cfg(target_arch = "wasm32")]
fn left_of_limits() -> Option<u64> {
    const PAGE_BYTES: u64 = 1 << 16;
    let taken_pages = core::arch::wasm32::memory_size::<0>() as u64;
    Some((1 << 32) - taken_pages * PAGE_BYTES)
}

#[cfg(not(any(target_os = "linux", target_arch = "wasm32")))]
fn left_of_limits() -> Option<u64> {
    None
}

/// `NAME   123 kB` in a table of the system.
fn field_bytes(table: &str, name: &str) -> Option<u64> {
    let table = fs::read_to_string(table).ok()?;
    let line = table.lines().find(|line| line.starts_with(name))?;
    let kib: u64 = line.split_ascii_whitespace().nth(1)?.parse().ok()?;
    Some(kib * 1024)
}

/// The files of a version of control groups.
struct Version {
    limit: &'static str,
    used: &'static str,
    /// Key in memory.stat of the bytes of cached files, which the system frees when memory runs short.
    cache: &'static str,
}

const V1: Version = Version {
    limit: "memory.limit_in_bytes",
    used: "memory.usage_in_bytes",
    cache: "total_inactive_file",
};
const V2: Version = Version {
    limit: "memory.max",
    used: "memory.current",
    cache: "inactive_file",
};

/// Least memory that the groups of a process and the groups above them have left. `groups` is the text of /proc/self/cgroup.
fn left_in_groups(groups: &str, root: &Path) -> Option<u64> {
    let of_line = |line: &str| {
        let mut parts = line.splitn(3, ':');
        let (_, controllers, path) = (parts.next()?, parts.next()?, parts.next()?);
        let is_memory = controllers.split(',').any(|name| name == "memory");
        let (root, version) = match (controllers, is_memory) {
            ("", _) => (root.to_owned(), V2),
            (_, true) => (root.join("memory"), V1),
            _ => return None,
        };
        // In a container the path may be one of the host; then the root is the container's own group.
        let group = root.join(path.trim_start_matches('/'));
        group
            .ancestors()
            .take_while(|group| group.starts_with(&root))
            .filter_map(|group| left_in_group(group, &version))
            .min()
    };
    groups.lines().filter_map(of_line).min()
}

fn left_in_group(group: &Path, version: &Version) -> Option<u64> {
    let read = |name: &str| fs::read_to_string(group.join(name)).ok();
    // "max" where there is none.
    let limit: u64 = read(version.limit)?.trim().parse().ok()?;
    let used: u64 = read(version.used)?.trim().parse().ok()?;
    let cache = read("memory.stat").and_then(|stat| {
        let line = stat
            .lines()
            .find(|line| line.split(' ').next() == Some(version.cache))?;
        line.split(' ').nth(1)?.parse().ok()
    });
    Some(limit.saturating_sub(used.saturating_sub(cache.unwrap_or(0))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_narrowest_group_counts() {
        let root = tempfile::tempdir().unwrap();
        let group = |path: &str, files: &[(&str, &str)]| {
            let folder = root.path().join(path);
            fs::create_dir_all(&folder).unwrap();
            for (name, text) in files {
                fs::write(folder.join(name), text).unwrap();
            }
        };
        group("a/b", &[("memory.max", "max\n"), ("memory.current", "5\n")]);
        let stat = "anon 600\ninactive_file 300\n";
        group(
            "a",
            &[
                ("memory.max", "1000\n"),
                ("memory.current", "900\n"),
                ("memory.stat", stat),
            ],
        );
        group(
            "memory/c",
            &[
                ("memory.limit_in_bytes", "700\n"),
                ("memory.usage_in_bytes", "100\n"),
            ],
        );
        assert_eq!(left_in_groups("0::/a/b\n", root.path()), Some(400));
        assert_eq!(
            left_in_groups("4:memory,cpu:/c\n1:pids:/a\n", root.path()),
            Some(600)
        );
        assert_eq!(left_in_groups("0::/gone\n", root.path()), None);
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn linux_tells() {
        assert!(available_bytes().is_some_and(|bytes| bytes > 1 << 20));
    }
}
