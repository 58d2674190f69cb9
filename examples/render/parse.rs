//! Values on the command line: sizes, points, ranges and colors.

use glam::DVec3;
use puncta::Background;

pub(crate) fn size(text: &str) -> Result<(u32, u32), String> {
    let side =
        |side: &str| side.trim().parse().map_err(|_| format!("{side:?} is no number of pixels"));
    let (width, height) = text.split_once(['x', 'X']).ok_or("write it as 1024x768")?;
    Ok((side(width)?, side(height)?))
}

pub(crate) fn point(text: &str) -> Result<DVec3, String> {
    numbers(text).map(DVec3::from)
}

pub(crate) fn range(text: &str) -> Result<[f64; 2], String> {
    let range: [f64; 2] = numbers(text)?;
    if range[0] < range[1] {
        Ok(range)
    } else {
        Err("the first number must be the lower one".into())
    }
}

/// `N` finite numbers with commas between them.
fn numbers<const N: usize>(text: &str) -> Result<[f64; N], String> {
    let number = |part: &str| match part.trim().parse::<f64>() {
        Ok(x) if x.is_finite() => Ok(x),
        _ => Err(format!("{part:?} is no finite number")),
    };
    let numbers: Vec<f64> = text.split(',').map(number).collect::<Result<_, _>>()?;
    let count = numbers.len();
    numbers.try_into().map_err(|_| format!("{N} numbers with commas between them, not {count}"))
}

pub(crate) fn background(text: &str) -> Result<Background, String> {
    match text {
        "transparent" => Ok(Background::Transparent),
        _ => match text.split_once(',') {
            Some((top, bottom)) => Ok(Background::Gradient(color(top)?, color(bottom)?)),
            None => color(text).map(Background::Solid),
        },
    }
}

fn color(text: &str) -> Result<[u8; 3], String> {
    let hex = match text.trim() {
        "black" => "000000",
        "white" => "ffffff",
        other => other.trim_start_matches('#'),
    };
    let is_color = hex.len() == 6 && hex.bytes().all(|byte| byte.is_ascii_hexdigit());
    let code = u32::from_str_radix(hex, 16).ok().filter(|_| is_color);
    let [_, r, g, b] = code.ok_or(format!("{text:?} is no color like #20a0ff"))?.to_be_bytes();
    Ok([r, g, b])
}
