//! Contact sheets: several pictures side by side on one, each with its title below.

use crate::canvas::overlay::{Align, Color, Overlay, TextStyle};
use crate::canvas::text::shortened;
use crate::error::PictureError;
use crate::picture::{MAX_IMAGE_SIDE, Picture, check_size};

/// Width and height that a tile should have to one another.
const ASPECT: f64 = 4.0 / 3.0;
/// Least width and height of a tile in pixels: nothing can be made out on smaller ones.
const LEAST_TILE: u32 = 24;
/// Size of the titles, in parts of the mean of a tile's width and height with all around it.
const TEXT_PART: f64 = 0.052;
/// Least size of the titles in pixels.
const LEAST_TEXT: f64 = 9.0;
/// Room below a tile for its title, in sizes of the text.
const TITLE_LINES: f64 = 1.9;
/// Room between and around tiles, in the same parts as the text.
const MARGIN_PART: f64 = 0.045;

/// A picture on a contact sheet.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Tile {
    /// What is written below.
    pub title: String,
    /// The picture.
    pub picture: Picture,
}

/// What a contact sheet is made on.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct SheetColors {
    /// RGBA of the ground.
    pub ground: [u8; 4],
    /// RGBA of the titles.
    pub text: [u8; 4],
    /// RGBA of a rim around the letters, for grounds that are not known.
    pub halo: Option<[u8; 4]>,
}

impl SheetColors {
    /// Dark on white.
    pub const LIGHT: Self = Self { ground: [255; 4], text: [38, 43, 51, 255], halo: None };
    /// Bright on nearly black.
    pub const DARK: Self = Self { ground: [27, 30, 35, 255], text: [222, 226, 232, 255], halo: None };
    /// Dark with a bright rim on nothing, to be put on anything.
    pub const TRANSPARENT: Self =
        Self { ground: [255, 255, 255, 0], text: [38, 43, 51, 255], halo: Some([255, 255, 255, 230]) };
}

/// Where everything is on a contact sheet. All lengths are in pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SheetLayout {
    /// Width and height of the whole sheet.
    pub size: [u32; 2],
    /// Tiles side by side.
    pub columns: u32,
    /// Tiles below one another.
    pub rows: u32,
    /// Width and height of a tile, without its title.
    pub tile: [u32; 2],
    /// Height of the room for the title below each tile.
    pub title_height: u32,
    /// Size of the letters per em.
    pub text_size: f32,
    /// Room between tiles and around all of them.
    pub margin: u32,
    /// The upper left corner of the first tile.
    pub first: [u32; 2],
}

impl SheetLayout {
    /// The upper left corner of a tile, counted from 0, row by row.
    pub fn place(&self, tile: u32) -> [u32; 2] {
        let [column, row] = [tile % self.columns, tile / self.columns];
        let [width, height] = self.tile;
        [
            self.first[0] + column * (width + self.margin),
            self.first[1] + row * (height + self.title_height + self.margin),
        ]
    }

    fn new(columns: u32, rows: u32, size: [u32; 2]) -> Option<Self> {
        let [across, down] = [f64::from(size[0]) / f64::from(columns), f64::from(size[1]) / f64::from(rows)];
        // The geometric mean, but tiles of a narrow strip do not get titles that are wider than they are.
        let scale = (across * down).sqrt().min(1.6 * across.min(down));
        let text_size = (TEXT_PART * scale).max(LEAST_TEXT);
        let title_height = (TITLE_LINES * text_size).round() as u32;
        let margin = (MARGIN_PART * scale).round().max(2.0) as u32;
        // What is left for tiles, divided among them.
        let share = |side: u32, count: u32, beside: u32| {
            let beside = margin.checked_add(count.checked_mul(margin.checked_add(beside)?)?)?;
            Some(side.checked_sub(beside)? / count).filter(|&length| length >= LEAST_TILE)
        };
        let tile = [share(size[0], columns, 0)?, share(size[1], rows, title_height)?];
        let left_over = |side: u32, count: u32, each: u32| (side - margin - count * (each + margin)) / 2 + margin;
        let first = [left_over(size[0], columns, tile[0]), left_over(size[1], rows, tile[1] + title_height)];
        Some(Self { size, columns, rows, tile, title_height, text_size: text_size as f32, margin, first })
    }

    /// Area of the largest picture of the wanted aspect on a tile.
    fn usable_area(&self) -> f64 {
        let width = f64::from(self.tile[0]).min(f64::from(self.tile[1]) * ASPECT);
        width * width / ASPECT
    }
}

/// Lays `count` tiles out on a sheet of some width and height. Where it is not said how many are side by side, it is as
/// suits pictures of 4:3 best.
///
/// # Errors
/// [`PictureError::ImageSize`], or [`PictureError::SheetSize`] where there is no tile at all or no room for all.
pub fn sheet_layout(count: usize, size: [u32; 2], columns: Option<u32>) -> Result<SheetLayout, PictureError> {
    let [width, height] = size;
    check_size(size)?;
    let refused = PictureError::SheetSize { width, height, count, columns };
    // No sheet holds more than a part of that many.
    let count = match u32::try_from(count) {
        Ok(count @ 1..=0x0FFF_FFFF) => count,
        _ => return Err(refused),
    };
    let candidates = match columns {
        Some(columns) => columns.min(count)..=columns.min(count),
        None => 1..=count.min(MAX_IMAGE_SIDE),
    };
    let layouts = candidates.filter(|&columns| columns > 0).filter_map(|columns| {
        let layout = SheetLayout::new(columns, count.div_ceil(columns), size)?;
        Some((layout.usable_area(), layout))
    });
    let best = layouts.reduce(|best, other| if other.0 > best.0 { other } else { best });
    best.map(|(_, layout)| layout).ok_or(refused)
}

/// Puts tiles on a sheet, row by row. Pictures that are not as large as the layout says are put in the middle of their
/// place, and cut off where they are larger. Titles that are too long lose their middle.
///
/// # Errors
/// [`PictureError::SheetSize`] for more tiles than the layout has places, [`PictureError::ImageSize`] for a layout that
/// [`sheet_layout`] did not make, [`PictureError::Encode`] for a picture with more or fewer pixels than it says.
pub fn contact_sheet(tiles: &[Tile], layout: &SheetLayout, colors: &SheetColors) -> Result<Picture, PictureError> {
    let SheetLayout { size: [width, height], columns, rows, tile: [tile_width, tile_height], .. } = *layout;
    let mut overlay = Overlay::new(width, height)?;
    if tiles.len() as u64 > u64::from(columns) * u64::from(rows) {
        return Err(PictureError::SheetSize { width, height, count: tiles.len(), columns: Some(columns) });
    }
    let mut sheet = Picture::filled(width, height, colors.ground);
    let halo = colors.halo.map(|color: Color| (layout.text_size * 0.16, color));
    let style = TextStyle { size: layout.text_size, color: colors.text, halo };
    for (tile, place) in tiles.iter().zip((0..).map(|index| layout.place(index))) {
        if !tile.picture.is_complete() {
            return Err(PictureError::Encode { format: "contact sheet", message: tile.picture.mismatch() });
        }
        let picture = cropped(&tile.picture, layout.tile);
        let left = place[0] + (tile_width - picture.width) / 2;
        sheet.paste(&picture, left, place[1] + (tile_height - picture.height) / 2);
        let middle = [
            place[0] as f32 + tile_width as f32 / 2.0,
            (place[1] + tile_height) as f32 + layout.title_height as f32 / 2.0,
        ];
        let title = shortened(&tile.title, tile_width as f32, style.size);
        overlay.text(&title, middle, Align::Center, &style);
    }
    overlay.draw_onto(&mut sheet);
    Ok(sheet)
}

/// The middle of a picture, no larger than a size.
fn cropped(picture: &Picture, [width, height]: [u32; 2]) -> std::borrow::Cow<'_, Picture> {
    let [width, height] = [picture.width.min(width), picture.height.min(height)];
    if [width, height] == [picture.width, picture.height] {
        return std::borrow::Cow::Borrowed(picture);
    }
    let [left, top] = [(picture.width - width) / 2, (picture.height - height) / 2].map(|skipped| skipped as usize);
    let rows = picture.pixels.chunks_exact(4 * picture.width as usize).skip(top).take(height as usize);
    let pixels = rows.flat_map(|row| &row[4 * left..4 * (left + width as usize)]).copied().collect();
    std::borrow::Cow::Owned(Picture { width, height, pixels })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Everything is on the sheet and nothing overlaps, with even margins.
    #[test]
    fn layouts_fill_the_sheet() {
        for size in [[1600, 1200], [800, 600], [1200, 1600], [4000, 500], [333, 777]] {
            for count in 1..=24 {
                for columns in [None, Some(1), Some(3), Some(100)] {
                    let Ok(layout) = sheet_layout(count, size, columns) else {
                        assert!(size.contains(&333) || columns.is_some(), "{count} on {size:?}");
                        continue;
                    };
                    let SheetLayout { columns: across, rows, tile, title_height, margin, .. } = layout;
                    assert!((across * rows) as usize >= count && (across * (rows - 1)) < count as u32);
                    assert!(columns.is_none_or(|columns| across == columns.min(count as u32)));
                    assert!(title_height as f32 > layout.text_size && margin >= 2);
                    let last = layout.place(across * rows - 1);
                    let ends = [last[0] + tile[0], last[1] + tile[1] + title_height];
                    for i in 0..2 {
                        let [before, after] = [layout.first[i], size[i] - ends[i]];
                        assert!(before >= margin && after >= margin && before.abs_diff(after) <= 1, "{layout:?}");
                    }
                    let next = layout.place(across);
                    assert_eq!(next[0], layout.first[0]);
                    assert_eq!(next[1], layout.first[1] + tile[1] + title_height + margin);
                }
            }
        }
    }

    #[test]
    fn tiles_are_near_four_to_three() {
        for (count, size, expected) in [
            (1, [1600, 1200], [1, 1]),
            (4, [1600, 1200], [2, 2]),
            (9, [1600, 1200], [3, 3]),
            (12, [1600, 1200], [4, 3]),
            (3, [2400, 700], [3, 1]),
            (3, [500, 1200], [1, 3]),
        ] {
            let layout = sheet_layout(count, size, None).expect("room");
            assert_eq!([layout.columns, layout.rows], expected, "{count} on {size:?}");
            let aspect = f64::from(layout.tile[0]) / f64::from(layout.tile[1]);
            assert!((1.1..1.7).contains(&aspect), "{layout:?}");
        }
    }

    #[test]
    fn sizes_grow_with_the_sheet() {
        let [small, large] = [1, 3].map(|scale| sheet_layout(6, [900 * scale, 600 * scale], None).expect("room"));
        assert_eq!(small.columns, large.columns);
        assert!((large.text_size / small.text_size - 3.0).abs() < 0.01);
        assert!(
            large.margin.abs_diff(3 * small.margin) <= 2 && large.title_height.abs_diff(3 * small.title_height) <= 2
        );
    }

    #[test]
    fn sheets_without_room_are_refused() {
        let refused = |count: usize, size: [u32; 2], columns: Option<u32>| {
            matches!(sheet_layout(count, size, columns), Err(PictureError::SheetSize { .. }))
        };
        assert!(refused(0, [800, 600], None) && refused(3, [800, 600], Some(0)));
        assert!(refused(100, [200, 200], None) && refused(50, [800, 600], Some(1)));
        assert!(refused(usize::MAX, [800, 600], None) && refused(1_000_000, [800, 600], Some(u32::MAX)));
        assert!(refused(1, [1, 1], None) && !refused(1, [64, 64], None));
        assert!(matches!(sheet_layout(1, [0, 9], None), Err(PictureError::ImageSize { .. })));
        assert!(matches!(sheet_layout(1, [9, u32::MAX], None), Err(PictureError::ImageSize { .. })));
        let layout = sheet_layout(2, [800, 600], None).expect("room");
        let tile = Tile { title: String::new(), picture: Picture::filled(1, 1, [0; 4]) };
        assert!(contact_sheet(&vec![tile.clone(); 3], &layout, &SheetColors::LIGHT).is_err());
        let broken = Tile { picture: Picture { pixels: Vec::new(), ..tile.picture }, ..tile };
        assert!(contact_sheet(&[broken], &layout, &SheetColors::LIGHT).is_err());
    }

    /// Each picture in its place, its title below it, nothing elsewhere.
    #[cfg(feature = "text")]
    #[test]
    fn sheets_hold_pictures_and_titles() {
        for colors in [SheetColors::LIGHT, SheetColors::DARK, SheetColors::TRANSPARENT] {
            let layout = sheet_layout(5, [640, 480], None).expect("room");
            let [width, height] = layout.tile;
            // As large as wanted, and also too small and too large.
            let sizes = [[width, height], [width, height], [20, 10], [width + 90, height + 50], [width, height]];
            let tiles: Vec<Tile> = (0..5_u8)
                .zip(sizes)
                .map(|(i, [width, height])| Tile {
                    title: if i == 1 { String::new() } else { "part.stl ".repeat(usize::from(i) * 40 + 1) },
                    picture: Picture::filled(width, height, [i * 50, 255 - i * 50, 128, 255]),
                })
                .collect();
            let sheet = contact_sheet(&tiles, &layout, &colors).expect("a sheet");
            assert_eq!([sheet.width, sheet.height], [640, 480]);
            let mut rest = sheet.clone();
            let mut wipe = |[left, top]: [u32; 2], [width, height]: [u32; 2]| {
                let mut found = Vec::new();
                for i in (top..top + height).flat_map(|y| (left..left + width).map(move |x| 4 * (y * 640 + x) as usize))
                {
                    found.push(<[u8; 4]>::try_from(&rest.pixels[i..i + 4]).expect("4 bytes"));
                    rest.pixels[i..i + 4].copy_from_slice(&colors.ground);
                }
                found
            };
            for (i, tile) in (0..).zip(&tiles) {
                let place = layout.place(i);
                let found = wipe(place, layout.tile);
                let shown = found.iter().filter(|pixel| **pixel == tile.picture.pixels[..4]).count() as u32;
                assert_eq!(shown, if i == 2 { 200 } else { width * height }, "tile {i}");
                // A rim around the letters reaches a little farther than the letters.
                let found = wipe([place[0] - 3, place[1] + height], [width + 6, layout.title_height]);
                let written = found.iter().filter(|pixel| **pixel != colors.ground).count();
                assert_eq!(written > 50, i != 1, "title {i}: {written}");
            }
            assert!(rest.pixels.chunks_exact(4).all(|pixel| pixel == colors.ground));
            assert_eq!(sheet.is_opaque(), colors.ground[3] == 255);
        }
    }
}
