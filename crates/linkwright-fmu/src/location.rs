//! Where the importer has put the resources: a URI in FMI 2.0, a path in FMI 3.0.

use std::path::PathBuf;

/// The path of a URI of a file, or of what is a path already.
pub(crate) fn path_of(location: &str) -> PathBuf {
    let Some(rest) = location.strip_prefix("file:") else { return PathBuf::from(location) };
    let path = match rest.strip_prefix("//") {
        // What stands before the path is the host.
        Some(rest) => rest.find('/').map_or("", |at| &rest[at..]),
        None => rest,
    };
    let path = decoded(path);
    // `/C:/folder` is `C:/folder`.
    let has_drive = path.len() > 2 && path.as_bytes()[2] == b':' && cfg!(windows);
    PathBuf::from(if has_drive { &path[1..] } else { &path[..] })
}

/// Bytes written as `%20`.
fn decoded(text: &str) -> String {
    let (bytes, mut found, mut at) = (text.as_bytes(), Vec::with_capacity(text.len()), 0);
    while at < bytes.len() {
        let code = text.get(at + 1..at + 3).filter(|_| bytes[at] == b'%');
        match code.and_then(|code| u8::from_str_radix(code, 16).ok()) {
            Some(byte) => {
                found.push(byte);
                at += 3;
            }
            None => {
                found.push(bytes[at]);
                at += 1;
            }
        }
    }
    String::from_utf8_lossy(&found).into_owned()
}

#[cfg(test)]
mod tests {
    use super::path_of;
    use std::path::Path;

    #[test]
    fn a_uri_is_the_path_that_it_encodes() {
        for location in ["file:///tmp/a%20b/resources", "file:/tmp/a%20b/resources", "/tmp/a b/resources"] {
            assert_eq!(path_of(location), Path::new("/tmp/a b/resources"), "{location}");
        }
        assert_eq!(path_of("file://localhost/tmp/%C3%A4"), Path::new("/tmp/ä"));
        assert_eq!(path_of("/tmp/100%"), Path::new("/tmp/100%"), "a path is not encoded");
    }
}
