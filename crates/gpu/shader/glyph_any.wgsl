// All records are drawn.

fn is_wanted(at: u32) -> bool {
    return true;
}
