//! How the window looks: dark, so that the picture is what shines.

use egui::{Color32, Context, CornerRadius, FontId, Margin, Stroke, TextStyle, ThemePreference};

pub(crate) const ACCENT: Color32 = Color32::from_rgb(94, 176, 239);
pub(crate) const GOOD: Color32 = Color32::from_rgb(112, 198, 140);
pub(crate) const WARM: Color32 = Color32::from_rgb(240, 178, 92);
pub(crate) const BAD: Color32 = Color32::from_rgb(240, 112, 104);
pub(crate) const TEXT: Color32 = Color32::from_rgb(208, 214, 224);
pub(crate) const FAINT: Color32 = Color32::from_rgb(134, 144, 160);
pub(crate) const PANEL: Color32 = Color32::from_rgb(23, 26, 32);
pub(crate) const WELL: Color32 = Color32::from_rgb(15, 17, 21);
const BUTTON: Color32 = Color32::from_rgb(41, 47, 57);
pub(crate) const LINE: Color32 = Color32::from_rgb(46, 52, 63);

/// A number for the window: its digits are more than enough for places and sizes there.
#[expect(clippy::cast_possible_truncation, reason = "rounding is what is meant")]
pub(crate) const fn rough(number: f64) -> f32 {
    number as f32
}

pub(crate) fn apply(context: &Context) {
    context.set_theme(ThemePreference::Dark);
    context.all_styles_mut(|style| {
        let visuals = &mut style.visuals;
        visuals.panel_fill = PANEL;
        visuals.window_fill = PANEL;
        visuals.extreme_bg_color = WELL;
        visuals.window_stroke = Stroke::new(1.0, LINE);
        visuals.selection.bg_fill = ACCENT.gamma_multiply(0.45);
        visuals.selection.stroke = Stroke::new(1.0, Color32::WHITE);
        visuals.hyperlink_color = ACCENT;
        visuals.slider_trailing_fill = true;
        let widgets = &mut visuals.widgets;
        widgets.noninteractive.bg_stroke = Stroke::new(1.0, LINE);
        widgets.noninteractive.fg_stroke = Stroke::new(1.0, TEXT);
        widgets.inactive.fg_stroke = Stroke::new(1.0, TEXT);
        for (state, lightness) in [
            (&mut widgets.inactive, 1.0),
            (&mut widgets.hovered, 1.35),
            (&mut widgets.active, 1.6),
            (&mut widgets.open, 1.2),
        ] {
            let lit = |channel: u8| (f32::from(channel) * lightness).round().min(255.0);
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "it is a whole number from 0 to 255"
            )]
            let [r, g, b] = [BUTTON.r(), BUTTON.g(), BUTTON.b()].map(|c| lit(c) as u8);
            state.weak_bg_fill = Color32::from_rgb(r, g, b);
            state.bg_fill = state.weak_bg_fill;
            state.bg_stroke = Stroke::NONE;
            state.corner_radius = CornerRadius::same(5);
            state.expansion = 0.0;
        }
        style.spacing.item_spacing = egui::vec2(8.0, 6.0);
        style.spacing.button_padding = egui::vec2(9.0, 4.0);
        style.spacing.interact_size.y = 24.0;
        style.spacing.slider_width = 150.0;
        style.spacing.combo_width = 150.0;
        style.spacing.menu_margin = Margin::same(6);
        style.text_styles.insert(TextStyle::Body, FontId::proportional(13.5));
        style.text_styles.insert(TextStyle::Button, FontId::proportional(13.5));
        style.text_styles.insert(TextStyle::Small, FontId::proportional(11.5));
        style.text_styles.insert(TextStyle::Monospace, FontId::monospace(12.5));
    });
}
